// Builds the Projection that shaders use from an engine's matrix. C++ only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tl/expected.hpp>

#include "projection.h"

namespace alcove::maths {

namespace detail {

inline bool all_finite(const mat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

// Why `m` is none of the projections that a Projection can hold; null when it is one.
inline const char* projection_fault(const mat4& m) {
  if (!all_finite(m)) return "the projection matrix holds a value that is not finite";
  const float slack = 1e-6f * (std::abs(m[0][0]) + std::abs(m[1][1]));
  if (m[0][0] == 0.0f || m[1][1] == 0.0f)
    return "the projection matrix flattens x or y: its first two diagonal elements must not be 0";
  if (std::abs(m[0][1]) > slack || std::abs(m[1][0]) > slack)
    return "the projection matrix mixes x and y: pass it without the display's rotation";
  if (std::abs(m[0][3]) > 1e-6f || std::abs(m[1][3]) > 1e-6f)
    return "the projection matrix tilts the image plane: its w must depend on z alone";
  if (std::abs(m[0][2]) > 1e-6f || std::abs(m[1][2]) > 1e-6f)
    return "the projection matrix has an oblique near plane: its depth must depend on z alone";
  if (m[2][3] > 0.0f || (m[2][3] == 0.0f && m[3][3] <= 0.0f))
    return "the projection matrix looks along +Z: view space must have the camera along -Z";
  if (m[2][3] != 0.0f && std::abs(m[3][3]) > -1e-6f * m[2][3])
    return "the projection matrix moves the eye along z: in perspective its w must be 0 where z is";
  if (double(m[2][2]) * double(m[3][3]) == double(m[3][2]) * double(m[2][3]))
    return "the projection matrix gives every point the same depth";
  return nullptr;
}

}  // namespace detail

// The Projection of `matrix`, which takes view space (right-handed, camera along -Z) to Vulkan clip
// space (y down, depth 0 to 1), column-major as in GLM, over an image of width x height pixels.
// Jitter belongs in the matrix. The error is a sentence (static storage) that says what is wrong.
[[nodiscard]] inline tl::expected<Projection, const char*> make_projection(const mat4& matrix,
                                                                           std::uint32_t width,
                                                                           std::uint32_t height) {
  if (width == 0 || height == 0) return tl::unexpected<const char*>("the image has no pixels");
  if (const char* fault = detail::projection_fault(matrix)) return tl::unexpected(fault);

  const dmat4 m(matrix);
  const dvec2 scale(m[0][0], m[1][1]), per_z(m[2][0], m[2][1]), constant(m[3][0], m[3][1]);
  const double w_per_depth = -m[2][3], w_constant = m[3][3];
  // clip.xy = scale * xy - per_z * depth + constant, and equals (2 uv - 1) w: solved for xy.
  const dvec2 slope_scale = 2.0 * w_per_depth / scale;
  const dvec2 slope_offset = (per_z - w_per_depth) / scale;
  const dvec2 origin_scale = 2.0 * w_constant / scale;
  const dvec2 origin_offset = (-constant - w_constant) / scale;

  Projection p;
  p.uv_to_slope = vec4(slope_scale, slope_offset);
  p.uv_to_origin = vec4(origin_scale, origin_offset);
  p.position_to_uv = vec4(0.5 * scale, 0.5 * (constant + w_constant));
  p.depth_to_uv = vec4(0.5 * (w_per_depth - per_z), w_per_depth, w_constant);

  // depth_ndc = (m22 z + m32) / w. It grows with distance unless depth is reversed.
  const bool reversed = m[2][2] * m[3][3] > m[3][2] * m[2][3];
  dvec4 unproject(m[3][3], -m[3][2], m[2][3], -m[2][2]);
  const double tile_size = 0.5 * unproject.z + unproject.w;
  if (tile_size < 0.0) unproject = -unproject;
  p.depth_unproject = vec4(unproject);
  p.sky = reversed ? vec2(-1.0f, 0.0f) : vec2(1.0f, 1.0f);
  const auto depth_at = [&](double ndc) {
    const double below = unproject.z * ndc + unproject.w;
    const double above = unproject.x * ndc + unproject.y;
    return float(below > 0.0 ? std::min(above / below, double(kSkyDepth)) : double(kSkyDepth));
  };
  p.near_far = vec2(depth_at(reversed ? 1.0 : 0.0), depth_at(reversed ? 0.0 : 1.0));

  if (w_per_depth > 0.0) {
    p.eye = vec4(-constant / scale, 0.0, 1.0);
  } else {
    p.eye = vec4(-slope_offset, 1.0, 0.0);
  }
  p.size_px = vec2(float(width), float(height));
  p.texel_uv = 1.0f / p.size_px;
  return p;
}

}  // namespace alcove::maths
