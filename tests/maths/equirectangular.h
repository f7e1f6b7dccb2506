// Returns the direction of a point of an equirectangular image as environment_map.h defines it.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "maths/constants.h"

namespace alcove::maths_test {

inline glm::vec3 equirectangular_direction(glm::vec2 uv) {
  const float angle = uv.x * 2.0f * maths::kPi;
  const float across = std::sin(uv.y * maths::kPi);
  return {across * std::sin(angle), std::cos(uv.y * maths::kPi), -across * std::cos(angle)};
}

}  // namespace alcove::maths_test
