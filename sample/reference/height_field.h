#pragma once

#include <cstdint>
#include <vector>

#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// The depth image as a surface: for every texel the inverse of its depth (perspective) or the depth
// itself (orthographic), either of which is linear across a flat face in the image; and whether the
// surface goes on to the next texel to the right and below.
//
// Between two texel centres that are joined the surface runs straight, so a plane is a plane; where
// they are not joined each texel is a column of its own width, as deep as you like.
struct HeightField {
  uint32_t width = 0, height = 0;
  std::vector<float> value;       // sky: 0 in perspective, far away in orthographic views
  std::vector<float> join_right;  // 1: the surface goes on to (x + 1, y); 0: it does not
  std::vector<float> join_below;
  glm::vec2 scale;  // view x and y of a pixel at depth 1 (or any): scale * pixel + origin
  glm::vec2 origin;
  bool orthographic = false;
};

// `depth_vs`: positive distance along the view axis, infinity (or not finite) in the sky.
[[nodiscard]] HeightField make_height_field(const Image<float>& depth_vs, const Camera& camera);
[[nodiscard]] bool is_sky(const HeightField& field, uint32_t x, uint32_t y);

// A texel that is no sky, as a place to look from; view space.
struct FieldPoint {
  uint32_t x = 0, y = 0;
  glm::vec3 centre;
  glm::vec3 view;        // unit, towards the eye
  glm::vec3 right, up;   // unit, with `view` a right-handed frame
  float radius = 0;      // of what may block
  int steps_x, steps_y;  // texels that the radius reaches
};
[[nodiscard]] FieldPoint field_point(const HeightField& field, uint32_t x, uint32_t y,
                                     float radius);

// The direction across the view vector at an angle from `right` towards `up`.
[[nodiscard]] glm::vec3 across_view(const FieldPoint& point, float phi);

// The angle from the view vector, [0, pi], of the nearest direction to it that the surface within
// the radius blocks on the side of `direction`, which across_view() gave or its negative.
[[nodiscard]] float horizon_angle(const HeightField& field, const FieldPoint& point,
                                  const glm::vec3& direction);

}  // namespace alcove::sample
