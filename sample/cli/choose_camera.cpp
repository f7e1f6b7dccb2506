#include "cli/choose_camera.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace alcove::sample {
namespace {

// Returns whether the axes of the view can be computed. For this, the squared lengths of the
// vectors that span them must be normal floats, neither too small nor too large.
bool has_axes(const Camera& camera) {
  const glm::vec3 back = camera.eye_ws - camera.target_ws;
  return std::isnormal(glm::dot(back, back)) &&
         std::isnormal(glm::dot(camera.up_ws, camera.up_ws)) &&
         std::isfinite(glm::dot(camera.eye_ws, camera.eye_ws));
}

// Returns the first camera names and the number of the others, because a file may have thousands.
std::string list_names(const std::vector<Camera>& cameras) {
  constexpr std::size_t kMost = 10;
  const std::size_t listed = std::min(cameras.size(), kMost);
  std::string names;
  for (std::size_t i = 0; i < listed; ++i)
    names += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", cameras[i].name);
  if (listed < cameras.size()) names += fmt::format(" and {} more", cameras.size() - listed);
  return names;
}

}  // namespace

bool uses_default_camera(const ViewOptions& view) {
  return view.camera.empty() && !view.eye && !view.target;
}

Result<Camera> choose_camera(const ViewOptions& view, const ViewFinder& finder) {
  const Scene& scene = finder.scene();
  const Camera* named = find_camera(scene, view.camera);
  if (!named && !view.camera.empty() && view.camera != kNoCamera) {
    return tl::unexpected(
        "the scene has no camera \"" + view.camera + "\"; it has " +
        (scene.cameras.empty() ? "none: use --eye and --target" : list_names(scene.cameras)));
  }
  const double aspect = static_cast<double>(view.width) / view.height;
  // A default camera that shows nothing, as one that was left in the file, is not what is wanted.
  if (uses_default_camera(view) && named && !finder.shows_subject(*named, aspect)) named = nullptr;
  Camera camera = named ? *named : finder.framing_camera(aspect);
  camera.origin = scene.origin;
  if (view.eye) camera.eye_ws = *view.eye - scene.origin;
  if (view.target) camera.target_ws = *view.target - scene.origin;
  // The name and the up vector of a camera only apply to that camera's own view.
  if (view.eye || view.target) {
    camera.name = "--eye";
    camera.up_ws = Camera().up_ws;
  }
  camera.up_ws = view.up_ws.value_or(camera.up_ws);
  if (view.fov_y) {
    camera.orthographic = false;
    camera.fov_y = *view.fov_y;
  }
  if (view.ortho_height) {
    camera.orthographic = true;
    camera.ortho_height = *view.ortho_height;
    if (std::isinf(camera.far_plane)) camera.far_plane = 1000.0f * camera.ortho_height;
  }
  camera.reversed_z = view.reversed_z.value_or(!camera.orthographic);
  camera.fit_planes = camera.fit_planes || view.eye || view.target || view.ortho_height;
  if (camera.eye_ws == camera.target_ws)
    return tl::unexpected<std::string>("--eye and --target are one point: move one of them");
  if (!has_axes(camera)) {
    return tl::unexpected<std::string>(
        "--eye, --target and --up are too large or too near each other for a view to be made: give "
        "lengths from 1e-15 to 1e15");
  }
  if (std::exchange(camera.fit_planes, false) && !(view.near_plane && view.far_plane))
    camera = finder.with_fitted_planes(camera, aspect);
  camera.near_plane = view.near_plane.value_or(camera.near_plane);
  camera.far_plane = view.far_plane.value_or(camera.far_plane);
  if (!camera.orthographic && !(camera.near_plane > 0.0f)) {
    return Failure(fmt::format(
        "the near plane ({}) of a perspective view must lie before the eye: give --near",
        camera.near_plane));
  }
  if (!(camera.near_plane < camera.far_plane)) {
    return Failure(
        fmt::format("the near plane ({}) is not before the far plane ({}): give --near and --far",
                    camera.near_plane, camera.far_plane));
  }
  return camera;
}

}  // namespace alcove::sample
