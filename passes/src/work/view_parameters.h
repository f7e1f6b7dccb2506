// Converts cameras and conventions to the parameters that the shaders use.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "alcove/alcove_work.h"
#include "alcove/passes/error.h"
#include "maths/projection.h"
#include "maths/slice_line.h"
#include "work/rigid_transform.h"

namespace alcove::passes {

// Returns whether a perspective matrix was given in row-major instead of column-major order: the
// coefficient 1 of w = -z is then found in the place of the depth offset. A perspective matrix with
// a scaled w could look the same, but engines do not use such matrices.
[[nodiscard]] inline bool is_transposed(const float (&clip_from_view)[16]) {
  const auto is_one = [](float value) { return std::abs(std::abs(value) - 1.0f) <= 1e-5f; };
  return is_one(clip_from_view[14]) && !is_one(clip_from_view[11]) && clip_from_view[11] != 0.0f &&
         clip_from_view[15] == 0.0f;
}

// Returns the projection of a camera onto an image of `size` pixels, or an error that says what is
// wrong with the camera. The sentence calls the view `name`.
[[nodiscard]] inline tl::expected<maths::Projection, Error> projection_of(
    const AlcoveCamera& camera, VkExtent2D size, const char* name = "The view") {
  const auto unusable = [name](const std::string& why) {
    return Error{std::string(name) + " cannot be used: " + why + "."};
  };
  if (!is_rigid(camera.view_from_world)) {
    return tl::unexpected(
        unusable("view_from_world is not a rotation and translation; it must be column-major, "
                 "without scale and finite"));
  }
  if (is_transposed(camera.clip_from_view))
    return tl::unexpected(unusable("clip_from_view is transposed; it must be column-major"));
  return maths::make_projection(to_mat4(camera.clip_from_view), size.width, size.height)
      .map_error(unusable);
}

// How the image NORMALS is meant. AlcoveViewInfo describes the fields.
struct NormalConvention {
  AlcoveNormalEncoding encoding = ALCOVE_NORMAL_ENCODING_SIGNED_XYZ;
  bool in_view_space = false;
  bool forward_z = false;
};

// Returns the convention of a view's normals, or of those that the passes make from depth.
[[nodiscard]] inline NormalConvention normals_of(const AlcoveViewInfo& info, bool given) {
  if (!given) return {.in_view_space = true};
  return {info.normal_encoding, info.normals_in_view_space != 0, info.normals_forward_z != 0};
}

// Returns the rotation or reflection from the space of the normals to view space.
[[nodiscard]] inline maths::mat4 view_from_normal(const AlcoveCamera& camera,
                                                  const NormalConvention& convention) {
  if (!convention.in_view_space) return maths::mat4(to_rigid(camera.view_from_world));
  maths::mat4 result(1.0f);
  if (convention.forward_z) result[2][2] = -1.0f;
  return result;
}

// How motion vectors are meant.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{};
};

[[nodiscard]] inline MotionConvention motion_of(const AlcoveViewInfo& info) {
  MotionConvention motion{{info.motion_scale[0], info.motion_scale[1]},
                          {info.motion_offset[0], info.motion_offset[1]}};
  if (motion.scale[0] == 0.0f && motion.scale[1] == 0.0f) motion.scale = {1.0f, 1.0f};
  return motion;
}

// Returns the resolution of a depth buffer of this format.
[[nodiscard]] inline maths::DepthStep depth_step(const maths::Projection& projection,
                                                 VkFormat format) {
  const double scale = std::abs(projection.inverse_depth_from_ndc.x);
  // The result is 1.5 times the step of the format, because rasterisers do not always round to the
  // nearest value.
  const auto fixed = [&](double levels) {
    return maths::DepthStep{static_cast<float>(1.5 * scale / levels), 0.0f};
  };
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_R16_UNORM:
      return fixed(65535.0);
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return fixed(16777215.0);
    default: {
      // Float formats have steps of at most 2^-23 of the stored depth, and of 2^-24 from 0.5 to 1.
      // The stored depth grows with the inverse depth in perspective if it is reversed, and in
      // orthographic views if it is not.
      const double step = std::ldexp(1.0, -23);
      // The inverse depth at which the stored depth is 0.
      const double zero = projection.inverse_depth_from_ndc.y +
                          (projection.perspective && !projection.reversed ? scale : 0.0);
      const double sign = projection.perspective == projection.reversed ? 1.0 : -1.0;
      return maths::DepthStep{static_cast<float>(-sign * step * zero),
                              static_cast<float>(sign * step)};
    }
  }
}

template <typename Parameters>
[[nodiscard]] std::span<const std::byte> bytes_of(const Parameters& parameters) {
  static_assert(std::is_trivially_copyable_v<Parameters> &&
                sizeof(Parameters) <= ALCOVE_MAX_WORK_PARAMETER_BYTES);
  return std::as_bytes(std::span(&parameters, 1));
}

}  // namespace alcove::passes
