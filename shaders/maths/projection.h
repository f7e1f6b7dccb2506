// The projection of a view, made from any Vulkan projection matrix: finite, infinite, reversed,
// off-centre, jittered, orthographic or flipped in Y. C++ only: shaders get what they need of it.
//
// View space is right-handed with the camera along -Z. Linear depth is the distance along -Z in
// scene units, positive in front of the eye. The near plane of an orthographic view may lie behind
// the eye. Positions on the image are in pixels, from the corner at the top left.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tl/expected.hpp>

#include "constants.h"
#include "language.h"

namespace alcove::maths {

struct Projection {
  // Converts (x s, y s, depth, 1) to a position in view space. (x, y) is a position on the image,
  // depth is the linear depth, and s is depth in perspective views and 1 in orthographic views.
  mat4 view_from_pixel;
  mat4 pixel_from_view;  // converts a position to (x w, y w, depth, w)
  // Scale and offset that inverse_depth_of_ndc() applies to values of the depth buffer.
  vec2 inverse_depth_from_ndc;
  vec2 near_far;     // linear depths of both planes; kSkyDepth if infinite
  vec2 size_px;      // of the image
  bool perspective;  // else orthographic
  bool reversed;     // values of the depth buffer fall with distance

  // The change from one pixel to the next of x and y of the view ray at unit linear depth.
  vec2 ray_per_px() const { return vec2(view_from_pixel[0][0], view_from_pixel[1][1]); }
  // ray_per_px(), and in zw x and y of the ray at the corner of the image.
  vec4 slope() const { return vec4(ray_per_px(), vec2(view_from_pixel[2])); }
  // Whether the far plane of a perspective projection is infinitely far away, so that its inverse
  // depth is 0.
  bool has_infinite_far() const { return perspective && inverse_depth_from_ndc.y == 0.0f; }
};

namespace detail {

inline bool all_finite(const mat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

// Tolerance for matrix elements that are zero in every projection, relative to the elements that
// they are compared with. The rounding errors of matrices that were multiplied or inverted in
// floats are well below it.
constexpr double kRounding = 1e-5;

// Least length in scene units, as kSkyDepth is the largest. Squares of both are normal floats.
const double kLeastLength = 1.0 / kSkyDepth;

// Returns whether the projection is orthographic: w does not depend on z within rounding errors.
inline bool is_orthographic(const dmat4& m) {
  const double w_per_z = std::abs(m[2][3]);
  return w_per_z == 0.0 ||
         (w_per_z <= kRounding * std::abs(m[3][3]) && w_per_z <= 1e-4 * std::abs(m[2][2]));
}

// Returns whether the constant part of the clip-space coordinate `row` (x, y or w), `per_length` of
// which is a movement of the eye by 1, is at most a rounding error in perspective. It then moves
// the eye by less than a ten-thousandth of the near plane's distance.
inline bool has_no_constant(const dmat4& m, int row, double per_length) {
  const double w_per_z = std::abs(m[2][3]);
  return std::abs(m[3][row]) * w_per_z <=
         std::abs(per_length) * std::max(1e-6 * w_per_z, 1e-4 * std::abs(m[3][2]));
}

// Returns whether `m` is a perspective projection times a rotated view matrix: its w is a distance
// along a unit vector that is not the z axis, and its x and y are at right angles.
inline bool is_view_projection(const dmat4& m) {
  const auto row = [&](int i) { return dvec3(m[0][i], m[1][i], m[2][i]); };
  const dvec3 x = row(0), y = row(1), w = row(3);
  return std::abs(length(w) - 1.0) < 1e-3 && std::abs(w.z) < 1.0 - 1e-6 &&
         std::abs(dot(x, y)) < 0.05 * length(x) * length(y);
}

// Returns the reason why `m` cannot be a Projection, or null if it can.
inline const char* projection_fault(const dmat4& m) {
  const double size = std::abs(m[0][0]) + std::abs(m[1][1]);
  const double w_size = std::abs(m[2][3]) + std::abs(m[3][3]);
  const double depth_size = std::abs(m[2][2]) + w_size;
  if (is_view_projection(m))
    return "the projection matrix looks like a view-projection: pass the projection alone";
  const auto is_scale = [&](double s) {
    return s >= kLeastLength * w_size && s * kLeastLength <= w_size;
  };
  if (!is_scale(std::abs(m[0][0])) || !is_scale(std::abs(m[1][1])))
    return "the projection matrix flattens or stretches x or y: its first two diagonal elements "
           "must be 1e-12 to 1e12 or the negative of that";
  if (std::abs(m[0][1]) > kRounding * size || std::abs(m[1][0]) > kRounding * size)
    return "the projection matrix mixes x and y: pass it without the display's rotation";
  if (std::abs(m[0][3]) > kRounding * w_size || std::abs(m[1][3]) > kRounding * w_size)
    return "the projection matrix tilts the image plane: its w must depend on z alone";
  if (std::abs(m[0][2]) > kRounding * depth_size || std::abs(m[1][2]) > kRounding * depth_size)
    return "the projection matrix has an oblique near plane: its depth must depend on z alone";
  const bool orthographic = is_orthographic(m);
  if (orthographic ? m[3][3] <= 0.0 : m[2][3] > 0.0)
    return "the projection matrix looks along +Z: convert it with "
           "ALCOVE_CAMERA_CONVENTION_FORWARD_Z, or, if it was converted with this bit, which "
           "DIRECT3D and UNREAL contain, without it";
  if (orthographic) return nullptr;
  if (!has_no_constant(m, 0, m[0][0]) || !has_no_constant(m, 1, m[1][1]))
    return "the projection matrix moves the eye along x or y: in perspective jitter and shifts of "
           "the image belong in its third column, and those of the eye in the view matrix";
  if (!has_no_constant(m, 3, m[2][3]))
    return "the projection matrix moves the eye along z: in perspective its w must be 0 where z is";
  return nullptr;
}

// Returns the projection `m` with exact zeros in the row of w.
inline dmat4 without_rounding(dmat4 m) {
  if (is_orthographic(m))
    m[2][3] = 0.0;
  else
    m[3][3] = 0.0;
  return m;
}

// Returns Projection::inverse_depth_from_ndc. Linear depth is (x depth_ndc + y) / (z depth_ndc + w)
// with x to w of `unproject`.
inline vec2 inverse_depth_from_ndc(const dvec4& unproject, bool perspective, bool reversed) {
  if (!perspective) return vec2(dvec2(unproject.x, unproject.y) / unproject.w);
  const dvec2 linear = dvec2(unproject.z, unproject.w) / unproject.y;
  const double far = reversed ? linear.y : linear.x + linear.y;
  // If the matrix has rounding errors, its inverse depth at the far plane can be slightly negative.
  return vec2(dvec2(std::abs(linear.x), std::max(far, 0.0)));
}

}  // namespace detail

// Returns the Projection of `matrix`, which maps view space (right-handed, camera along -Z) to
// Vulkan clip space (y down, depth 0 to 1), for an image of width x height pixels. The matrix is
// column-major as in GLM, and includes the jitter. Rounding errors in elements that are zero in a
// projection are accepted and removed. The error is a clause (a string literal) that says what is
// wrong with the matrix.
[[nodiscard]] inline tl::expected<Projection, const char*> make_projection(const mat4& matrix,
                                                                           std::uint32_t width,
                                                                           std::uint32_t height) {
  if (width == 0 || height == 0) return tl::unexpected<const char*>("the image has no pixels");
  if (!detail::all_finite(matrix))
    return tl::unexpected<const char*>("the projection matrix holds a value that is not finite");
  const dmat4 given(matrix);
  if (const char* fault = detail::projection_fault(given)) return tl::unexpected(fault);

  const dmat4 m = detail::without_rounding(given);
  const dvec2 scale(m[0][0], m[1][1]), per_z(m[2][0], m[2][1]), constant(m[3][0], m[3][1]);
  const double w_per_depth = -m[2][3], w_constant = m[3][3];
  Projection p{};
  p.size_px = vec2(float(width), float(height));
  p.perspective = w_per_depth > 0.0;
  // depth_ndc = (m22 z + m32) / w. It grows with distance unless depth is reversed.
  p.reversed = m[2][2] * m[3][3] > m[3][2] * m[2][3];

  // clip.xy = scale * xy - per_z * depth + constant, and equals (2 pixel / size - 1) w: solved for
  // xy. Either w_per_depth or w_constant is 0.
  const vec2 ray_per_px = vec2(2.0 * (w_per_depth + w_constant) / scale) * (1.0f / p.size_px);
  p.view_from_pixel = mat4(0.0f);
  p.view_from_pixel[0][0] = ray_per_px.x;
  p.view_from_pixel[1][1] = ray_per_px.y;
  p.view_from_pixel[2] = vec4(vec2((per_z - w_per_depth) / scale), -1.0f, 0.0f);
  p.view_from_pixel[3] = vec4(vec2((-constant - w_constant) / scale), 0.0f, 1.0f);
  p.pixel_from_view = mat4(0.0f);
  const vec2 px_per_length = vec2(0.5 * scale) * p.size_px;
  p.pixel_from_view[0][0] = px_per_length.x;
  p.pixel_from_view[1][1] = px_per_length.y;
  p.pixel_from_view[2] = -vec4(vec2(0.5 * (w_per_depth - per_z)) * p.size_px, 1.0f, w_per_depth);
  p.pixel_from_view[3] = vec4(vec2(0.5 * (constant + w_constant)) * p.size_px, 0.0f, w_constant);

  // Linear depth is (x depth_ndc + y) / (z depth_ndc + w).
  dvec4 unproject(m[3][3], -m[3][2], m[2][3], -m[2][2]);
  if (0.5 * unproject.z + unproject.w < 0.0) unproject = -unproject;
  p.inverse_depth_from_ndc = detail::inverse_depth_from_ndc(unproject, p.perspective, p.reversed);
  const auto depth_at = [&](double ndc) {
    const double below = unproject.z * ndc + unproject.w;
    const double above = unproject.x * ndc + unproject.y;
    return below > 0.0 ? std::min(above / below, double(kSkyDepth)) : double(kSkyDepth);
  };
  const dvec2 near_far(depth_at(p.reversed ? 1.0 : 0.0), depth_at(p.reversed ? 0.0 : 1.0));
  if (near_far.x < (p.perspective ? detail::kLeastLength : -kSkyDepth) || near_far.x >= near_far.y)
    return tl::unexpected<const char*>(
        "the projection matrix has no range of depth: its near plane must lie less than 1e12 from "
        "the eye, in perspective at least 1e-12 in front of it, and before the far plane");
  p.near_far = vec2(near_far);
  return p;
}

}  // namespace alcove::maths
