// Tests filter and history at half resolution, and the upsampling pass that computes pixels from
// them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>

#include "gtao_scenes.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "reconstruct_fixture.h"
#include "work/interleave_offset.h"

namespace alcove::passes {
namespace {

// Tolerance for the rounding of stored sums, of 16-bit texels, and of reciprocals on a software
// device.
constexpr float kRounding = 1e-3f;

OcclusionSettings half_resolution(std::uint32_t history_frames) {
  OcclusionSettings settings = precise(history_frames);
  settings.half_resolution = 1;
  return settings;
}

TEST(HalfTexelPacking, PackedTexelsOfHalfResolutionFitTheRangeMinusOneToOne) {
  maths::HalfTexel texel;
  texel.occlusion = 1.0f;
  texel.weight = static_cast<float>(maths::kMaxHistoryFrames);
  texel.tilt = maths::vec2(maths::kLargestTilt, -maths::kLargestTilt);
  const maths::vec4 stored = maths::pack_half_texel(texel);
  EXPECT_EQ(stored.x, 1.0f);
  EXPECT_EQ(stored.y, 127.0f / 128.0f);
  EXPECT_EQ(stored.z, 1.0f);
  EXPECT_EQ(stored.w, -1.0f);
}

// Returns the recent occlusion of a stored depth, or 0.25 if none is stored.
float recent_of(float stored) {
  return maths::half_recent_of_code(maths::half_texel_recent_code(stored), 0.25f);
}

TEST(HalfTexelPacking, PackingKeepsInverseDepthAndRecentOcclusionApproximately) {
  for (const float inverse_depth : {1e-12f, 0.013f, 0.7f, 20.0f, 1e12f}) {
    const float depth_alone = maths::half_texel_depth(inverse_depth, 0.5f, false);
    EXPECT_NEAR(depth_alone / inverse_depth, 1.0, 3.1e-5);
    EXPECT_EQ(recent_of(depth_alone), 0.25f);
    for (const float recent : {0.0f, 0.01f, 0.37f, 1.0f}) {
      const float depth = maths::half_texel_depth(inverse_depth, recent, true);
      EXPECT_NEAR(depth / inverse_depth, 1.0, 3.1e-5);
      EXPECT_NEAR(recent_of(depth), recent, 0.004);
    }
  }
}

class HalfResolution : public Reconstruct {};

TEST_F(HalfResolution, ConstantRawOcclusionGivesConstantVisibilityAtOddImageSizes) {
  const TestView view = test_views()[2];
  std::vector<NamedScene> scenes = gtao_scenes();
  scenes.push_back({"grazing", {tilted_plane(75.0, 4.0)}});
  for (const NamedScene& scene : scenes) {
    const Drawing drawing = draw(view, 33, 23, scene.scene);
    for (const std::uint32_t tile_size : {2u, 4u, 8u}) {
      for (const float visibility : {0.37f, 1.0f}) {
        const HostImage raw_occlusion = constant_raw_occlusion(
            tile_count(33, tile_size), tile_count(23, tile_size), visibility);
        for (const std::uint32_t history : {0u, 16u}) {
          SCOPED_TRACE(testing::Message()
                       << scene.name << ", tiles of " << tile_size << ", visibility " << visibility
                       << ", history " << history);
          const HostImage image = reconstruct({.drawing = drawing,
                                               .raw_occlusion = raw_occlusion,
                                               .tile_size = tile_size,
                                               .index = 1,
                                               .reset = true},
                                              half_resolution(history));
          expect_pixels(image, visibility == 1.0f ? 1e-6f : kRounding,
                        [&](std::uint32_t x, std::uint32_t y) {
                          return drawing.is_sky(x, y) ? 1.0f : visibility;
                        });
        }
      }
    }
  }
}

// A near wall covers the left half of a far wall, and each wall has its own visibility. The edge
// between them lies in an odd column, so that some texels of 2x2 pixels contain pixels of both
// walls.
TEST_F(HalfResolution, UpsampledVisibilityDoesNotLeakAcrossADepthEdge) {
  const TestView view = test_views()[2];
  Shape near_wall = plane({0.0, 0.0, -3.0}, {0.0, 0.0, 1.0});
  near_wall.keep = [](const glm::dvec3& p) { return p.x < 0.05; };
  const Drawing drawing = draw(view, kWidth, kHeight, {near_wall, tilted_plane(0.0, 12.0)});
  const float near_ndc = drawing.depth_ndc.at(0, 0);
  const auto expected = [&](std::uint32_t x, std::uint32_t y) {
    return drawing.depth_ndc.at(x, y) == near_ndc ? 0.2f : 0.9f;
  };
  for (const std::uint32_t index : {0u, 1u, 2u, 3u}) {
    const InterleaveOffset offset = interleave_offset_of(2, index);
    const HostImage raw_occlusion =
        raw_occlusion_of(kWidth / 2, kHeight / 2, [&](std::uint32_t x, std::uint32_t y) {
          return expected(2 * x + offset.x, 2 * y + offset.y);
        });
    const HostImage image = reconstruct({.drawing = drawing,
                                         .raw_occlusion = raw_occlusion,
                                         .tile_size = 2,
                                         .index = index,
                                         .reset = true},
                                        half_resolution(16));
    SCOPED_TRACE(index);
    expect_pixels(image, 0.02, expected);
  }
}

// With dynamic resolution the history's textures are larger than the image. Beyond the image's
// border they hold results of an earlier, larger image. history_frames is 1, so that nothing but
// this frame and such texels could enter the result.
TEST_F(HalfResolution, StaleHistoryTexelsOutsideTheRenderedPartOfAnImageAreNotRead) {
  constexpr VkExtent2D kLargest{kWidth, kHeight};
  const TestView view = test_views()[2];
  const Drawing large = draw_plane(0.0);
  const Drawing small = draw(view, kWidth / 2, kHeight / 2, {tilted_plane(0.0, 4.0)});
  const HostImage dark = constant_raw_occlusion(kWidth / 2, kHeight / 2, 0.1f);
  const HostImage bright = constant_raw_occlusion(kWidth / 4, kHeight / 4, 0.9f);
  (void)reconstruct({.drawing = large,
                     .raw_occlusion = dark,
                     .tile_size = 2,
                     .reset = true,
                     .previous_size = kLargest,
                     .largest_size = kLargest},
                    half_resolution(1));
  const HostImage image = reconstruct({.drawing = small,
                                       .raw_occlusion = bright,
                                       .tile_size = 2,
                                       .index = 1,
                                       .previous_size = kLargest,
                                       .largest_size = kLargest},
                                      half_resolution(1));
  EXPECT_THAT(image.texels, testing::Each(testing::FloatNear(0.9f, kRounding)));
}

}  // namespace
}  // namespace alcove::passes
