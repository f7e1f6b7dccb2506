#pragma once

// Includes GLM for a depth range of 0 to 1. alcove_sample_support defines the macro for every
// target that links it. A file that is compiled without it would silently use another depth range.
#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#error "link alcove_sample_support, which defines GLM_FORCE_DEPTH_ZERO_TO_ONE"
#endif

#include <cmath>
#include <glm/glm.hpp>

namespace alcove::sample {

// Returns the unit vector along `v`, or zero if `v` is zero or not finite.
[[nodiscard]] inline glm::dvec3 direction_of(const glm::dvec3& v) {
  const double length = glm::length(v);
  return std::isfinite(length) && length > 0.0 ? v / length : glm::dvec3(0.0);
}

}  // namespace alcove::sample
