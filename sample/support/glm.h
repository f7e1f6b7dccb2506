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

// Returns the matrix that transforms normals as `m` transforms points: the inverse transpose times
// the absolute value of the determinant, which exists even if that is 0.
[[nodiscard]] inline glm::dmat3 cofactor(const glm::dmat3& m) {
  const double side = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
  return {side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]),
          side * glm::cross(m[0], m[1])};
}

}  // namespace alcove::sample
