// What the passes' C++ needs of a View, in the types that the shaders share.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "alcove/passes/frame.h"
#include "maths/make_projection.h"

namespace alcove::passes {

[[nodiscard]] inline maths::mat4 to_mat4(const Matrix& matrix) {
  maths::mat4 result;
  for (int i = 0; i < 16; ++i) {
    result[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)];
  }
  return result;
}

// A rotation leaves its axes at right angles and of length 1, and so does a mirror, which a
// left-handed world needs. Engines scale rarely, and hand over transposed matrices often.
[[nodiscard]] inline bool is_rotation_and_translation(const Matrix& m) {
  constexpr float kSlack = 1e-3f;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a; b < 3; ++b) {
      const float* const u = &m[4 * a];
      const float* const v = &m[4 * b];
      const float dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      if (!(std::abs(dot - (a == b ? 1.0f : 0.0f)) <= kSlack)) {
        return false;
      }
    }
  }
  return m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f && std::isfinite(m[12]) &&
         std::isfinite(m[13]) && std::isfinite(m[14]);
}

// Whether the 1 by which a perspective has w from z stands where the depth of its near plane does.
// Such a matrix is a perspective too, of a scaled w and between other planes, and nobody's.
[[nodiscard]] inline bool is_transposed(const Matrix& clip_from_view) {
  const float w_from_z = std::abs(clip_from_view[11]);
  return std::abs(clip_from_view[14]) == 1.0f && w_from_z != 1.0f && w_from_z != 0.0f;
}

// The projection of a view over an image of `size` pixels, or what is wrong with the view, which
// the sentence calls `name`.
[[nodiscard]] inline tl::expected<maths::Projection, Error> projection_of(
    const View& view, VkExtent2D size, const char* name = "The view") {
  const auto unusable = [name](const std::string& why) {
    return Error{std::string(name) + " cannot be used: " + why + "."};
  };
  if (!is_rotation_and_translation(view.view_from_world)) {
    return tl::unexpected(
        unusable("view_from_world is no rotation and translation; it must be column-major, without "
                 "scale and finite"));
  }
  if (is_transposed(view.clip_from_view)) {
    return tl::unexpected(unusable("clip_from_view is transposed; it must be column-major"));
  }
  return maths::make_projection(to_mat4(view.clip_from_view), size.width, size.height)
      .map_error(unusable);
}

// The same over the whole of `texture`.
[[nodiscard]] inline tl::expected<maths::Projection, Error> projection_of(
    const Frame& frame, const View& view, framegraph::Texture texture) {
  const VkExtent3D extent = frame.graph.extent(texture);
  return projection_of(view, {extent.width, extent.height});
}

// The rotation that turns normals into view space.
[[nodiscard]] inline maths::mat4 view_from_normal(const Frame& frame, bool normals_in_view_space) {
  return normals_in_view_space ? maths::mat4(1.0f) : to_mat4(frame.view.view_from_world);
}

[[nodiscard]] inline bool is_perspective(const maths::Projection& projection) {
  return projection.eye.w > 0.0f;
}

[[nodiscard]] inline bool is_reversed(const maths::Projection& projection) {
  return projection.sky.x < 0.0f;
}

// From raw depth to a number that is linear along the image of any plane, 1/depth in perspective
// and depth in orthographic views: x * depth_ndc + y.
[[nodiscard]] inline maths::vec2 inverse_depth_from_ndc(const maths::Projection& projection) {
  const maths::vec4& unproject = projection.depth_unproject;
  return is_perspective(projection) ? maths::vec2(unproject.z, unproject.w) / unproject.y
                                    : maths::vec2(unproject.x, unproject.y) / unproject.w;
}

template <typename Parameters>
[[nodiscard]] std::span<const std::byte> bytes_of(const Parameters& parameters) {
  static_assert(std::is_trivially_copyable_v<Parameters> &&
                sizeof(Parameters) <= Kernels::kMaxParameterBytes);
  return std::as_bytes(std::span(&parameters, 1));
}

}  // namespace alcove::passes
