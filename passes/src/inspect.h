// Finds mistakes of the engine in a few thousand samples of depth and normals: cameras and formats
// that the engine names and that do not fit the samples.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// A pixel: its depth, the depths of its four neighbours and its normal, all as the images store
// them.
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
  VkExtent2D size{};        // of the part in use
  VkExtent2D depth_size{};  // of the images, as the device has them
  VkExtent2D normals_size{};
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool has_normals = false;
  bool normals_in_view_space = false;
  bool normals_forward_z = false;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  float radius = 0.0f;
};

enum class Mistake : std::uint8_t {
  depth_reversed,        // depth runs the other way than the projection says
  depth_from_minus_one,  // the projection is OpenGL's, with depth from -1 to 1
  field_of_view,         // normals fit the depth with another angle of view, or other planes
  normal_space,          // world space for view space, or the other way round
  normal_packing,        // packed normals read as signed ones, or the other way round
  normal_forward_z,      // z of the normals has the other sign
  flipped_y,             // y of the projection has the other sign than the image
  radius_too_small,
  radius_too_large,
  image_too_small,  // smaller than the part that is said to be in use
  count,
};

// Returns a sentence for the engine's programmer that says what is wrong and what to do.
[[nodiscard]] const char* sentence(Mistake mistake);

using Mistakes = std::array<bool, static_cast<std::size_t>(Mistake::count)>;

// Returns the mistakes that the samples show: none if there are too few samples.
[[nodiscard]] Mistakes inspect(const InspectedView& view, std::span<const PixelSample> samples);

}  // namespace alcove::passes
