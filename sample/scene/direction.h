#pragma once

#include <cmath>

#include "support/glm.h"

namespace alcove::sample {

// Returns the unit vector along `v`, or zero if `v` is zero or not finite.
[[nodiscard]] inline glm::dvec3 direction_of(const glm::dvec3& v) {
  const double length = glm::length(v);
  return std::isfinite(length) && length > 0.0 ? v / length : glm::dvec3(0.0);
}

}  // namespace alcove::sample
