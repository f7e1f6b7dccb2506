// Finds mistakes of the caller by means of the pixels of a view's inputs. A few thousand samples of
// depth and normals are compared with the camera and the formats that the view states.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// A sampled pixel: its depth and those of its four neighbours, and its normal, all as they are
// stored in the textures.
struct PixelSample {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  float depth = 0.0f;
  float left = 0.0f;
  float right = 0.0f;
  float up = 0.0f;
  float down = 0.0f;
  std::array<float, 3> normal{};
};

// The engine's description of the view that the samples are from.
struct InspectedView {
  View view;
  VkExtent2D size{};        // of the part of the image that is in use
  VkExtent2D depth_size{};  // of the whole images, as the device reports them
  VkExtent2D normals_size{};
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool has_normals = false;
  bool normals_in_view_space = false;
  bool normals_forward_z = false;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  float radius = 0.0f;
};

enum class Mistake : std::uint8_t {
  depth_reversed,        // depth is reversed and the projection is not, or the other way round
  depth_from_minus_one,  // the projection is OpenGL's, with depth from -1 to 1
  field_of_view,         // the normals fit the depth with another field of view or other planes
  normal_space,          // normals are in world space instead of view space, or the other way round
  normal_packing,        // normals in [0,1] are read as signed ones, or the other way round
  normal_forward_z,      // z of the normals has the wrong sign
  flipped_y,             // y of the projection has the wrong sign for the image
  radius_too_small,
  radius_too_large,
  image_too_small,  // the image is smaller than the part of it that is in use
  count,
};

// Returns a sentence that says what is wrong and what to do.
[[nodiscard]] const char* sentence(Mistake mistake);

using Mistakes = std::array<bool, static_cast<std::size_t>(Mistake::count)>;

// Returns the mistakes that the samples show. With too few samples for a conclusion, the result is
// empty.
[[nodiscard]] Mistakes inspect(const InspectedView& view, std::span<const PixelSample> samples);

}  // namespace alcove::passes
