#pragma once

#include <cstdint>
#include <string>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// A view of the scene. Positions are in world space, lengths in scene units, angles in radians.
// View space is right-handed with the camera along -Z and +Y up; clip space is Vulkan's: y down in
// the framebuffer, depth 0..1.
struct Camera {
  std::string name;
  glm::vec3 eye_ws{0.0f, 0.0f, 0.0f};
  glm::vec3 target_ws{0.0f, 0.0f, -1.0f};  // not the eye
  glm::vec3 up_ws{0.0f, 1.0f, 0.0f};       // need not be perpendicular; may be parallel to the view
  bool orthographic = false;
  float fov_y = 1.0471976f;    // perspective: whole vertical angle, (0, pi)
  float ortho_height = 2.0f;   // orthographic: height of the view, > 0
  float near_plane = 0.1f;     // > 0 in perspective; any value below far_plane in orthographic
  float far_plane = 100.0f;    // > near_plane; infinity is allowed in perspective
  bool reversed_z = false;     // near at depth 1, far at depth 0
  glm::vec2 offset_ndc{0.0f};  // point of the image that the view axis meets, -1..1, y down
  glm::vec2 jitter_px{0.0f};   // offset of the image in pixels, x right, y down
  // A copy of Scene::origin. It is added to positions before they are printed, and subtracted from
  // positions that the user types.
  glm::dvec3 origin{0.0};
  bool fit_planes = false;  // choose_camera() still has to fit near and far plane to the view
};

// The matrices of a camera. To reproject the history, the caller keeps those of the previous frame.
struct CameraMatrices {
  glm::mat4 view_from_world;
  glm::mat4 world_from_view;
  glm::mat4 clip_from_view;
  glm::mat4 view_from_clip;
  glm::mat4 clip_from_world;
};

// Returns the matrices for an image of `width` x `height` pixels, both above 0. The size determines
// the aspect ratio and the effect of the jitter.
[[nodiscard]] CameraMatrices camera_matrices(const Camera& camera, uint32_t width, uint32_t height);

// The ray through a point of the image, in world space. `pixel` is in pixels from the top left
// corner; (0.5, 0.5) is the centre of the first pixel. `direction_ws` is unit. In perspective views
// the ray begins at the eye, in orthographic views on the plane through the eye.
struct Ray {
  glm::vec3 origin_ws;
  glm::vec3 direction_ws;
};
[[nodiscard]] Ray camera_ray(const CameraMatrices& matrices, bool orthographic, glm::vec2 pixel,
                             uint32_t width, uint32_t height);

// Returns the positive distance along the view axis for a value of the depth buffer, and infinity
// for the value of an infinite far plane.
[[nodiscard]] double view_depth(const glm::mat4& clip_from_view, double depth_ndc);

// Returns the distance along the view axis for each value of a depth buffer, and infinity at pixels
// without a surface.
[[nodiscard]] Image<float> linear_depth(const Camera& camera, const Image<float>& depth_ndc);

// Returns the camera with its eye rotated about the target by `angle` radians around `up_ws`, as
// `--orbit` does.
[[nodiscard]] Camera orbited(const Camera& camera, float angle);

}  // namespace alcove::sample
