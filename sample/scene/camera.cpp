#include "scene/camera.h"

#include <cmath>
#include <limits>

namespace alcove::sample {
namespace {

// Returns the axes right, up and back of the camera. They are valid even if `up_ws` is zero or
// parallel to the view direction.
glm::mat3 camera_axes(const Camera& camera) {
  const glm::vec3 back = glm::normalize(camera.eye_ws - camera.target_ws);
  glm::vec3 right = glm::cross(camera.up_ws, back);
  if (glm::dot(right, right) < 1e-10f * glm::dot(camera.up_ws, camera.up_ws) ||
      glm::dot(right, right) == 0.0f) {
    const glm::vec3 other = std::abs(back.y) > 0.9f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    right = glm::cross(other, back);
  }
  right = glm::normalize(right);
  return {right, glm::cross(back, right), back};
}

// The two entries of the third row of a projection matrix, with which clip z = scale * z_vs +
// offset. The clip-space w is -z_vs in perspective and 1 in orthographic views.
struct DepthRow {
  double scale;
  double offset;
};

DepthRow perspective_depth(double near_plane, double far_plane) {
  if (std::isinf(far_plane)) return {-1.0, -near_plane};
  return {far_plane / (near_plane - far_plane), near_plane * far_plane / (near_plane - far_plane)};
}

DepthRow orthographic_depth(double near_plane, double far_plane) {
  return {1.0 / (near_plane - far_plane), near_plane / (near_plane - far_plane)};
}

glm::mat4 projection(const Camera& camera, double aspect) {
  glm::dmat4 p(0.0);
  DepthRow depth;
  if (camera.orthographic) {
    p[0][0] = 2.0 / (camera.ortho_height * aspect);
    p[1][1] = -2.0 / camera.ortho_height;
    p[3][3] = 1.0;
    depth = orthographic_depth(camera.near_plane, camera.far_plane);
    if (camera.reversed_z) depth = {-depth.scale, 1.0 - depth.offset};
  } else {
    const double focal = 1.0 / std::tan(0.5 * camera.fov_y);
    p[0][0] = focal / aspect;
    p[1][1] = -focal;
    p[2][3] = -1.0;
    depth = perspective_depth(camera.near_plane, camera.far_plane);
    if (camera.reversed_z) depth = {-1.0 - depth.scale, -depth.offset};
  }
  p[2][2] = depth.scale;
  p[3][2] = depth.offset;
  return p;
}

}  // namespace

CameraMatrices camera_matrices(const Camera& camera, uint32_t width, uint32_t height) {
  const glm::mat3 axes = camera_axes(camera);
  CameraMatrices out;
  out.world_from_view = glm::mat4(axes);
  out.world_from_view[3] = glm::vec4(camera.eye_ws, 1.0f);
  const glm::mat3 transposed = glm::transpose(axes);
  out.view_from_world = glm::mat4(transposed);
  out.view_from_world[3] = glm::vec4(-(transposed * camera.eye_ws), 1.0f);

  glm::dmat4 clip = projection(camera, static_cast<double>(width) / height);
  const glm::dvec2 shift = glm::dvec2(camera.offset_ndc) +
                           2.0 * glm::dvec2(camera.jitter_px) / glm::dvec2(width, height);
  for (int column = 0; column < 4; ++column) {
    clip[column][0] += shift.x * clip[column][3];
    clip[column][1] += shift.y * clip[column][3];
  }
  out.clip_from_view = clip;
  out.view_from_clip = glm::inverse(glm::dmat4(out.clip_from_view));
  out.clip_from_world = clip * glm::dmat4(out.view_from_world);
  return out;
}

Ray camera_ray(const CameraMatrices& matrices, bool orthographic, glm::vec2 pixel, uint32_t width,
               uint32_t height) {
  const glm::mat4& p = matrices.clip_from_view;
  const glm::vec2 ndc = 2.0f * pixel / glm::vec2(width, height) - 1.0f;
  const glm::mat3 rotation(matrices.world_from_view);
  const glm::vec3 eye(matrices.world_from_view[3]);
  if (orthographic) {
    const glm::vec3 point((ndc.x - p[3][0]) / p[0][0], (ndc.y - p[3][1]) / p[1][1], 0.0f);
    return {eye + rotation * point, -rotation[2]};
  }
  const glm::vec3 direction((ndc.x + p[2][0]) / p[0][0], (ndc.y + p[2][1]) / p[1][1], -1.0f);
  return {eye, glm::normalize(rotation * direction)};
}

double view_depth(const glm::mat4& clip_from_view, double depth_ndc) {
  const glm::dmat4 p(clip_from_view);
  if (p[2][3] == 0.0) return (p[3][2] - depth_ndc) / p[2][2];
  const double w = p[2][2] + depth_ndc;
  return w == 0.0 ? std::numeric_limits<double>::infinity() : p[3][2] / w;
}

Camera orbited(const Camera& camera, float angle) {
  // An angle of 0 must leave the camera exactly the same. Computing the eye from the target and the
  // rotated arm would change it by rounding if the target is much farther from the origin than the
  // eye.
  if (angle == 0.0f) return camera;
  Camera out = camera;
  const glm::vec3 axis = glm::normalize(camera.up_ws);
  const glm::vec3 arm = camera.eye_ws - camera.target_ws;
  const float c = std::cos(angle), s = std::sin(angle);
  out.eye_ws = camera.target_ws + arm * c + glm::cross(axis, arm) * s +
               axis * glm::dot(axis, arm) * (1.0f - c);
  return out;
}

Image<float> linear_depth(const Camera& camera, const Image<float>& depth_ndc) {
  const CameraMatrices matrices = camera_matrices(camera, depth_ndc.width, depth_ndc.height);
  const auto linear = [&, sky = camera.reversed_z ? 0.0f : 1.0f](float depth) {
    return depth == sky ? std::numeric_limits<float>::infinity()
                        : static_cast<float>(view_depth(matrices.clip_from_view, depth));
  };
  return mapped(linear, depth_ndc);
}

}  // namespace alcove::sample
