#pragma once

#include <cstdint>
#include <vector>

#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// The depth image as a surface. For each texel it holds the inverse depth (in orthographic views
// the depth), which is linear in screen space across a flat face, and whether the surface is
// connected to the next texel to the right and below.
//
// Between connected texel centres the surface is interpolated linearly, so that a plane stays a
// plane. An unconnected texel is a solid block one texel wide that extends infinitely away from the
// eye.
struct HeightField {
  uint32_t width = 0, height = 0;
  std::vector<float>
      value;  // inverse depth or depth; sky: 0 in perspective, 1e15 in orthographic views
  std::vector<float> connected_right;  // 1: connected to texel (x + 1, y); 0: not connected
  std::vector<float> connected_below;  // 1: connected to texel (x, y + 1); 0: not connected
  glm::vec2 scale;  // view x and y of a pixel at depth 1 (orthographic: any depth): scale * pixel +
                    // origin
  glm::vec2 origin;
  bool orthographic = false;
};

// `depth_vs`: positive distance along the view axis, infinity (or not finite) in the sky.
[[nodiscard]] HeightField make_height_field(const Image<float>& depth_vs, const Camera& camera);
[[nodiscard]] bool is_sky(const HeightField& field, uint32_t x, uint32_t y);

// A texel with a surface, at which the visibility is computed; view space.
struct FieldPoint {
  uint32_t x = 0, y = 0;
  glm::vec3 centre;
  glm::vec3 view;        // unit, towards the eye
  glm::vec3 right, up;   // unit; (right, up, view) is a right-handed basis
  float radius = 0;      // radius of the occlusion
  int steps_x, steps_y;  // texels that the radius spans along each axis of the image
};
[[nodiscard]] FieldPoint field_point(const HeightField& field, uint32_t x, uint32_t y,
                                     float radius);

// The direction perpendicular to the view direction, at an angle from `right` towards `up`.
[[nodiscard]] glm::vec3 across_view(const FieldPoint& point, float phi);

// Returns the horizon angle, [0,pi]: the smallest angle from the view direction at which the
// surface within the radius occludes the half-slice towards `direction`. `direction` is a result of
// across_view() or its negative.
[[nodiscard]] float horizon_angle(const HeightField& field, const FieldPoint& point,
                                  const glm::vec3& direction);

}  // namespace alcove::sample
