#include "scene/gltf_camera.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace alcove::sample {
namespace {

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

// Sets position and axes from the node. Returns false if its matrix gives no direction or is too
// large.
bool place(const glm::dmat4& world_from_node, PlacedCamera& out) {
  constexpr double kFarthest = 1e15;  // scene units, the limit for vertices too
  const glm::dvec3 eye(world_from_node[3]), back(world_from_node[2]), up(world_from_node[1]);
  if (!positive(glm::length(back)) || !positive(glm::length(up)) ||
      !(glm::length(eye) <= kFarthest))
    return false;
  out.camera.eye_ws = eye;
  out.camera.up_ws = glm::normalize(up);
  out.forward_ws = -glm::normalize(back);
  return true;
}

// Sets the projection, its angle or size, and the near and far plane. Returns false if they are not
// valid.
bool read_lens(const tinygltf::Camera& in, Camera& out) {
  double near_plane = 0.0, far_plane = 0.0;
  if (in.type == "orthographic") {
    out.orthographic = true;
    out.ortho_height = static_cast<float>(2.0 * std::abs(in.orthographic.ymag));
    near_plane = in.orthographic.znear;
    far_plane = in.orthographic.zfar;
    if (!positive(out.ortho_height)) return false;
  } else {
    out.fov_y = static_cast<float>(in.perspective.yfov);
    near_plane = in.perspective.znear;
    far_plane = in.perspective.zfar > 0.0 ? in.perspective.zfar : INFINITY;
    // The limits of the option --fov-y, so that every camera of a file can also be given by
    // options.
    constexpr float kNarrowest = 2e-5f, kWidest = 3.1f;
    const bool opens = out.fov_y >= kNarrowest && out.fov_y <= kWidest;
    if (!positive(near_plane) || !opens) return false;
  }
  if (!std::isfinite(near_plane) || !(far_plane > near_plane)) return false;
  out.near_plane = static_cast<float>(near_plane);
  out.far_plane = static_cast<float>(far_plane);
  return out.far_plane > out.near_plane;
}

}  // namespace

void add_camera(const tinygltf::Model& model, const tinygltf::Node& node,
                const glm::dmat4& world_from_node, std::vector<PlacedCamera>& cameras,
                Scene& scene) {
  if (node.camera < 0) return;
  const auto index = static_cast<size_t>(node.camera);
  PlacedCamera out;
  if (index >= model.cameras.size() || !place(world_from_node, out) ||
      !read_lens(model.cameras[index], out.camera)) {
    scene.warnings.push_back("Camera of node \"" + node.name + "\" is malformed and left out.");
    return;
  }
  const std::string& name = model.cameras[index].name;
  out.camera.name = !name.empty() ? name : node.name;
  if (out.camera.name.empty()) out.camera.name = "camera" + std::to_string(cameras.size());
  cameras.push_back(std::move(out));
}

Camera aimed(const PlacedCamera& placed, const Bounds& bounds_ws) {
  constexpr double kRounding =
      1e-3;  // of the distance from the origin, where floats are 1e-7 of it apart
  constexpr double kNearest = 1e-15;  // scene units, the limit of choose_camera()
  Camera camera = placed.camera;
  const glm::dvec3 low(bounds_ws.low), high(bounds_ws.high), eye(camera.eye_ws);
  const double depth = glm::dot(0.5 * (low + high) - eye, placed.forward_ws);
  camera.target_ws = eye + placed.forward_ws * std::max({depth, 0.05 * glm::length(high - low),
                                                         kRounding * glm::length(eye), kNearest});
  return camera;
}

}  // namespace alcove::sample
