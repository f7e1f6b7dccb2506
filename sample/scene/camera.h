#pragma once

#include <cstdint>
#include <string>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// A view of the scene. World space, scene units, radians. View space is right-handed with the
// camera along -Z and +Y up; clip space is Vulkan's: y down in the framebuffer, depth 0..1.
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
  glm::vec2 offset_ndc{0.0f};  // off-centre: where the view axis meets the image, -1..1, y down
  glm::vec2 jitter_px{0.0f};   // offset of the image in pixels, x right, y down
  // Scene::origin. It is added to positions that are printed and subtracted from typed ones.
  glm::dvec3 origin{0.0};
  bool fit_planes = false;  // near and far are provisional: camera_of() fits them to the view
};

// A camera as shaders and ray casting use it. For the previous frame's matrices the caller keeps
// those of the frame before.
struct CameraMatrices {
  glm::mat4 view_from_world;
  glm::mat4 world_from_view;
  glm::mat4 clip_from_view;
  glm::mat4 view_from_clip;
  glm::mat4 clip_from_world;
};

// `width` and `height` in pixels, both > 0: they give the aspect ratio and the size of a jitter.
[[nodiscard]] CameraMatrices camera_matrices(const Camera& camera, uint32_t width, uint32_t height);

// The ray through a point of the image in world space. `pixel` in pixels from the top left corner
// (0.5, 0.5 is the first pixel's centre). `direction_ws` is unit; the origin is the eye, or in
// orthographic views the point of the eye's plane.
struct Ray {
  glm::vec3 origin_ws;
  glm::vec3 direction_ws;
};
[[nodiscard]] Ray camera_ray(const CameraMatrices& matrices, bool orthographic, glm::vec2 pixel,
                             uint32_t width, uint32_t height);

// Positive distance along the view axis of a depth buffer's value; infinity for the value of an
// infinite far plane.
[[nodiscard]] double view_depth(const glm::mat4& clip_from_view, double depth_ndc);

// Distance along the view axis of each value of a depth buffer; infinity in the sky.
[[nodiscard]] Image<float> linear_depth(const Camera& camera, const Image<float>& depth_ndc);

// The camera orbited about its target by `angle` radians around `up_ws`, as by `--orbit`.
[[nodiscard]] Camera orbited(const Camera& camera, float angle);

}  // namespace alcove::sample
