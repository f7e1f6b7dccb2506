#pragma once

#include <cstdint>
#include <random>

#include "drawing.h"
#include "pass_fixture.h"

namespace alcove::passes {

// Tests the pass reconstruct alone, with raw occlusion that the tests write.
class Reconstruct : public PassTest {
 protected:
  static constexpr std::uint32_t kWidth = 32;
  static constexpr std::uint32_t kHeight = 24;

  struct Input {
    const Drawing& drawing;
    const HostImage& raw_occlusion;  // two channels, one texel per tile
    AlcoveCamera view = drawing.view;
    std::uint32_t tile_size = 1;
    std::uint32_t slices = 1;
    const HostImage* motion = nullptr;
    AlcoveCamera previous_view = view;
    std::uint32_t index = 0;
    bool reset = index == 0;
    std::uint32_t static_frames = 0;
    bool coarse_depth = false;  // the depth buffer has 16 bits instead of floats
    VkExtent2D previous_size{};
    VkExtent2D largest_size{};
  };

  // Returns visibility.
  HostImage reconstruct(const Input& input, const OcclusionSettings& settings);
  // Draws in the same view as most tests.
  static Drawing draw_scene(const Scene& scene) {
    return draw(test_views()[2], kWidth, kHeight, scene);
  }
  static Drawing draw_plane(double tilt_degrees, double distance = 4.0) {
    return draw_scene({tilted_plane(tilt_degrees, distance)});
  }
  static HostImage noise_raw_occlusion(std::mt19937& random);
  static HostImage no_motion();
};

// Returns the number of tiles of `tile_size` pixels that cover `pixels` pixels.
[[nodiscard]] constexpr std::uint32_t tile_count(std::uint32_t pixels, std::uint32_t tile_size) {
  return (pixels + tile_size - 1) / tile_size;
}

[[nodiscard]] OcclusionSettings precise(std::uint32_t history_frames);

// Returns a raw occlusion whose unoccluded part varies around 0.9, with the given visibility.
template <typename Visibility>
HostImage raw_occlusion_of(std::uint32_t width, std::uint32_t height,
                           const Visibility& visibility) {
  HostImage raw_occlusion{width, height, {}, 2};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const float weight = 0.8f + 0.1f * static_cast<float>((x + y) % 3);
      raw_occlusion.texels.push_back(visibility(x, y) * weight);
      raw_occlusion.texels.push_back(weight);
    }
  }
  return raw_occlusion;
}

[[nodiscard]] HostImage constant_raw_occlusion(std::uint32_t width, std::uint32_t height,
                                               float visibility);

// Returns the drawing with the same depth, in which the normals from column `first` on are rotated
// about the vertical axis.
[[nodiscard]] Drawing rotate_normals(const Drawing& drawing, double degrees, std::uint32_t first);

[[nodiscard]] double variance(const HostImage& image);

}  // namespace alcove::passes
