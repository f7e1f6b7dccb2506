// Removes the engine's rounding errors from a view_from_world matrix.
#pragma once

#include <cmath>
#include <cstddef>

#include "alcove/alcove_camera.h"
#include "maths/language.h"

namespace alcove::passes {

[[nodiscard]] inline maths::mat4 to_mat4(const float (&matrix)[16]) {
  maths::mat4 result;
  for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = matrix[i];
  return result;
}

// Returns whether `m` is a rotation or a reflection (for left-handed worlds) with a translation, up
// to rounding errors. It is not if an engine passes a scaled or transposed matrix by mistake. A
// camera matrix that was inverted in floats has rounding errors of at most about 1e-6.
[[nodiscard]] inline bool is_rigid(const float (&m)[16]) {
  constexpr float kAxes = 1e-3f;  // tolerance of dot products between axes
  constexpr float kRow = 1e-5f;   // tolerance of the elements of the last row that should be 0
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a; b < 3; ++b) {
      const float* const u = &m[4 * a];
      const float* const v = &m[4 * b];
      const float dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      if (!(std::abs(dot - (a == b ? 1.0f : 0.0f)) <= kAxes)) return false;
    }
  }
  return std::abs(m[3]) <= kRow && std::abs(m[7]) <= kRow && std::abs(m[11]) <= kRow &&
         std::abs(m[15] - 1.0f) <= kAxes && std::isfinite(m[12]) && std::isfinite(m[13]) &&
         std::isfinite(m[14]);
}

// Returns the rigid transform nearest to `matrix`, which must satisfy is_rigid(): axes of length 1
// at right angles, and the last row 0 0 0 1. The Gram-Schmidt process is used. Its result depends
// on which axis goes first, but by far less than a pixel.
[[nodiscard]] inline maths::dmat4 to_rigid(const float (&matrix)[16]) {
  const maths::dmat4 m(to_mat4(matrix));
  const maths::dvec3 x = maths::normalize(maths::dvec3(m[0]));
  const maths::dvec3 y =
      maths::normalize(maths::dvec3(m[1]) - maths::dot(maths::dvec3(m[1]), x) * x);
  const maths::dvec3 given_z(m[2]);
  const maths::dvec3 z =
      maths::normalize(given_z - maths::dot(given_z, x) * x - maths::dot(given_z, y) * y);
  return {maths::dvec4(x, 0.0), maths::dvec4(y, 0.0), maths::dvec4(z, 0.0),
          maths::dvec4(maths::dvec3(m[3]) / m[3][3], 1.0)};
}

}  // namespace alcove::passes
