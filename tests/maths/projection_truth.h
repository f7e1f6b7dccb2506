// Projects view-space positions to uv, as the reference for image-space computations of shaders.
#pragma once

#include "maths/projection.h"

namespace alcove::maths_test {

// Returns the uv of a view-space position whose perspective divisor is positive.
inline glm::vec2 uv_of_position(const maths::Projection& p, glm::vec3 position) {
  const float depth = -position.z;
  const glm::vec2 sum = glm::vec2(p.position_to_uv) * glm::vec2(position) +
                        glm::vec2(p.depth_to_uv) * depth +
                        glm::vec2(p.position_to_uv.z, p.position_to_uv.w);
  return sum / (p.depth_to_uv.z * depth + p.depth_to_uv.w);
}

}  // namespace alcove::maths_test
