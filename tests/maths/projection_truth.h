// Points of the image and of view space by a Projection, as the reference for image-space
// computations of shaders. Positions on the image are in pixels.
#pragma once

#include <algorithm>

#include "maths/projection.h"
#include "maths/slice_line.h"

namespace alcove::maths_test {

// Returns the pixel of a view-space position whose perspective divisor is positive.
inline glm::vec2 pixel_of(const maths::Projection& p, glm::vec3 position) {
  const glm::vec4 image = p.pixel_from_view * glm::vec4(position, 1.0f);
  return glm::vec2(image) / image.w;
}

inline glm::vec3 position_at(const maths::Projection& p, glm::vec2 pixel, float depth) {
  const float scale = p.perspective ? depth : 1.0f;
  return p.view_from_pixel * glm::vec4(pixel * scale, depth, 1.0f);
}

// Returns the unit vector from the surface at a pixel towards the eye.
inline glm::vec3 view_at(const maths::Projection& p, glm::vec2 pixel) {
  const glm::vec4 slope = p.slope();
  const glm::vec2 from_corner = p.perspective ? pixel * glm::vec2(slope) : glm::vec2(0.0f);
  return normalize(glm::vec3(-glm::vec2(slope.z, slope.w) - from_corner, 1.0f));
}

// Returns the linear depth of a value of the depth buffer.
inline float linear_depth(const maths::Projection& p, float depth_ndc) {
  const float inverse_depth =
      maths::inverse_depth_of_ndc(p.inverse_depth_from_ndc, depth_ndc, p.perspective, p.reversed);
  return p.perspective ? std::min(1.0f / inverse_depth, maths::kSkyDepth) : inverse_depth;
}

}  // namespace alcove::maths_test
