// Tests the spatial filter and the upsampling with raw occlusion that the tests write.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "gtao_scenes.h"
#include "reconstruct_fixture.h"
#include "work/interleave_offset.h"

namespace alcove::passes {
namespace {

// One coordinate of a traced pixel: the index of its tile, and the coordinate of the pixel.
struct TracedCoordinate {
  std::uint32_t tile;
  std::uint32_t pixel;
};

constexpr int kRadius = 2;  // of the filter, in tiles

// Returns the coordinate of traced pixel number `i`, 0 to 2 * kRadius - 1, along one axis of the
// window of a pixel's filter.
TracedCoordinate traced_around(std::uint32_t pixel, std::uint32_t size, std::uint32_t tile_size,
                               std::uint32_t interleave_offset, int i) {
  const int step = static_cast<int>(tile_size);
  const int before = static_cast<int>(pixel) - static_cast<int>(interleave_offset);
  const int tile_before = before >= 0 ? before / step : -1;
  const int last = static_cast<int>(tile_count(size, tile_size)) - 1;
  const auto tile =
      static_cast<std::uint32_t>(std::clamp(tile_before - (kRadius - 1) + i, 0, last));
  return {tile, std::min(tile * tile_size + interleave_offset, size - 1)};
}

double squared_distance(std::uint32_t a, std::uint32_t b) {
  const auto apart = static_cast<double>(a) - static_cast<double>(b);
  return apart * apart;
}

// Returns the filtered value that a pixel must have in its first frame, on a wall that faces the
// eye: the weighted mean of the traced pixels around it, without the corners of the window.
double mean_around(const HostImage& raw_occlusion, std::uint32_t x, std::uint32_t y,
                   std::uint32_t width, std::uint32_t height, std::uint32_t tile_size,
                   InterleaveOffset interleave_offset) {
  const double window_px = 1.1 * tile_size;  // half-width of the window for one slice
  double visible = 0.0;
  double open = 0.0;
  for (int j = 0; j < 2 * kRadius; ++j) {
    const TracedCoordinate row = traced_around(y, height, tile_size, interleave_offset.y, j);
    for (int i = 0; i < 2 * kRadius; ++i) {
      const auto outermost = [](int place) { return place == 0 || place == 2 * kRadius - 1; };
      if (outermost(i) && outermost(j)) continue;
      const TracedCoordinate column = traced_around(x, width, tile_size, interleave_offset.x, i);
      const double squared = squared_distance(column.pixel, x) + squared_distance(row.pixel, y);
      const double weight = std::pow(1.0 + 0.125 * squared / (window_px * window_px), -4.0);
      const std::size_t texel = (std::size_t{row.tile} * raw_occlusion.width + column.tile) * 2;
      visible += weight * raw_occlusion.texels[texel];
      open += weight * raw_occlusion.texels[texel + 1];
    }
  }
  return visible / open;
}

// The filter reads two traced pixels on each side at any tile size, up to the last row and column.
TEST_F(Reconstruct, PixelWithoutHistoryIsTheWeightedMeanOfTheTracedPixelsAroundIt) {
  constexpr std::uint32_t kOddWidth = 33;
  constexpr std::uint32_t kOddHeight = 23;
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kOddWidth, kOddHeight, {tilted_plane(0.0, 4.0)});
  const std::uint32_t seed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(0.2f, 0.8f);
  for (const std::uint32_t tile_size : {2u, 4u}) {
    const HostImage raw_occlusion =
        raw_occlusion_of(tile_count(kOddWidth, tile_size), tile_count(kOddHeight, tile_size),
                         [&](std::uint32_t, std::uint32_t) { return noise(random); });
    for (const std::uint32_t index : {0u, 1u, 2u, 7u}) {
      for (const std::uint32_t history : {0u, 16u}) {
        SCOPED_TRACE(testing::Message()
                     << "by " << tile_size << ", frame " << index << ", history " << history);
        const HostImage image = reconstruct({.drawing = drawing,
                                             .raw_occlusion = raw_occlusion,
                                             .tile_size = tile_size,
                                             .index = index,
                                             .reset = true},
                                            precise(history));
        const InterleaveOffset interleave_offset = interleave_offset_of(tile_size, index);
        // Weights are unoccluded parts, stored with an error of 1/120.
        expect_pixels(image, 6e-4, [&](std::uint32_t x, std::uint32_t y) {
          return mean_around(raw_occlusion, x, y, kOddWidth, kOddHeight, tile_size,
                             interleave_offset);
        });
      }
    }
  }
}

TEST_F(Reconstruct, ConstantRawOcclusionGivesConstantVisibilityInAnySceneAtAnyTileSize) {
  const TestView view = test_views()[2];
  std::vector<NamedScene> scenes = gtao_scenes();
  scenes.push_back({"grazing", {tilted_plane(75.0, 4.0)}});
  Shape wires = plane({0.0, 0.0, -3.0}, {0.0, 0.0, 1.0});
  wires.keep = [](const glm::dvec3& p) { return std::abs(std::remainder(p.x, 0.9)) < 0.08; };
  scenes.push_back({"wires", {wires, tilted_plane(10.0, 8.0)}});
  for (const NamedScene& scene : scenes) {
    const Drawing drawing = draw(view, 33, 23, scene.scene);
    for (const std::uint32_t tile_size : {1u, 2u, 4u}) {
      const HostImage raw_occlusion =
          constant_raw_occlusion(tile_count(33, tile_size), tile_count(23, tile_size), 0.37f);
      for (const std::uint32_t history : {0u, 16u}) {
        SCOPED_TRACE(testing::Message()
                     << scene.name << " by " << tile_size << ", history " << history);
        for (std::uint32_t frame = 0; frame < (history == 0 ? 1u : 4u); ++frame) {
          const HostImage image = reconstruct({.drawing = drawing,
                                               .raw_occlusion = raw_occlusion,
                                               .tile_size = tile_size,
                                               .index = frame},
                                              precise(history));
          // With a history the tolerance is larger, because the history stores its sums in 16
          // bits, and these sums are small if no traced pixel is near.
          expect_pixels(image, history == 0 ? 1e-4 : 0.02, [&](std::uint32_t x, std::uint32_t y) {
            return drawing.is_sky(x, y) ? 1.0f : 0.37f;
          });
        }
      }
    }
  }
}

TEST_F(Reconstruct, SpatialFilterReducesNoiseOnATiltedPlane) {
  const std::uint32_t seed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const HostImage raw_occlusion = noise_raw_occlusion(random);
  for (const double tilt : {0.0, 30.0, 50.0}) {
    const Drawing drawing = draw_plane(tilt);
    const auto noise_of = [&](std::uint32_t slices) {
      return variance(reconstruct(
          {.drawing = drawing, .raw_occlusion = raw_occlusion, .slices = slices}, precise(0)));
    };
    EXPECT_LT(noise_of(1), 0.2 * noise_of(8)) << tilt << " degrees";  // 8 slices are not filtered
  }
}

// With more slices the filter is narrower, so that stripes of four pixels keep more contrast.
TEST_F(Reconstruct, SpatialFilterBlursLessWithMoreSlicesPerPixel) {
  const Drawing drawing = draw_plane(0.0);
  const HostImage raw_occlusion = raw_occlusion_of(
      kWidth, kHeight, [](std::uint32_t x, std::uint32_t) { return x % 8 < 4 ? 0.3f : 0.7f; });
  double contrast = 0.0;
  for (const std::uint32_t slices : {1u, 2u, 4u}) {
    const HostImage image = reconstruct(
        {.drawing = drawing, .raw_occlusion = raw_occlusion, .slices = slices}, precise(0));
    EXPECT_GT(variance(image), 1.1 * contrast) << slices << " slices";
    contrast = variance(image);
  }
  EXPECT_LT(contrast, 0.04) << "no more than the variance of the unfiltered stripes";
}

// A pixel without history is also averaged with neighbours on the other side of a crease, which are
// a fraction of a pixel away from its tangent plane. Their weight must decrease with the number of
// slices and of frames.
TEST_F(Reconstruct, LeakOfVisibilityAcrossACreaseDecreasesWithMoreSlicesAndFrames) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, groove(0.8, 4.5));
  const HostImage raw_occlusion =
      raw_occlusion_of(kWidth, kHeight, [&](std::uint32_t x, std::uint32_t y) {
        return cast(drawing.scene, drawing.camera.ray(x + 0.5, y + 0.5))->normal.x > 0.0 ? 0.2f
                                                                                         : 0.9f;
      });
  const auto leak = [&](const HostImage& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.texels.size(); ++i) {
      sum +=
          std::abs(image.texels[i] - raw_occlusion.texels[i * 2] / raw_occlusion.texels[i * 2 + 1]);
    }
    return sum;
  };
  const auto after = [&](std::uint32_t slices, std::uint32_t frames) {
    HostImage image;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      image = reconstruct(
          {.drawing = drawing, .raw_occlusion = raw_occlusion, .slices = slices, .index = frame},
          precise(64));
    }
    return leak(image);
  };
  const double first = after(1, 1);
  EXPECT_GT(first, 1.0) << "sum over all pixels";
  EXPECT_LT(after(4, 1), 0.35 * first);
  // Dithering of the stored visibilities alone adds 0.16 to the sum over all pixels, which is 3e-4
  // per pixel.
  EXPECT_LT(after(1, 48), 0.2 * first);
}

// Tests neighbours that lie on the pixel's tangent plane but have another normal.
TEST_F(Reconstruct, NeighboursWithOtherNormalsGetSmallerFilterWeights) {
  const Drawing flat = draw_plane(0.0, 5.0);
  const std::uint32_t half = kWidth / 2;
  const HostImage raw_occlusion = raw_occlusion_of(
      kWidth, kHeight, [&](std::uint32_t x, std::uint32_t) { return x < half ? 0.9f : 0.2f; });
  const auto leak = [&](double degrees) {
    const HostImage image = reconstruct({.drawing = rotate_normals(flat, degrees, half),
                                         .raw_occlusion = raw_occlusion,
                                         .slices = 4,
                                         .reset = true},
                                        precise(0));
    return 0.9 - image.at(half - 1, kHeight / 2);
  };
  EXPECT_GT(leak(0.0), 0.1);
  EXPECT_LT(leak(60.0), 0.5 * leak(0.0));
  EXPECT_GT(leak(60.0), 0.05 * leak(0.0)) << "neighbours with other normals must keep some weight";
}

// Whether the last frame of a moving camera depends on the normals of a plane, away from the border
// of the image.
TEST_F(Reconstruct, NormalsOfAPlaneAreReadOnlyIfTheDepthBufferIsTooCoarseForItsTangentPlane) {
  for (TestView view : test_views()) {
    // Small pixels, so that a step of 16 bits is large in comparison.
    const float zoom = 100.0f;
    view.view.clip_from_view[0] *= zoom;
    view.view.clip_from_view[5] *= zoom;
    const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(20.0, 4.0)});
    const Drawing rotated = rotate_normals(drawing, 60.0, 0);
    const HostImage raw_occlusion =
        raw_occlusion_of(kWidth / 4, kHeight / 4, [](std::uint32_t x, std::uint32_t y) {
          return 0.3f + 0.1f * static_cast<float>((3 * x + y) % 5);
        });
    AlcoveCamera before = view.view;
    before.view_from_world[12] += 1e-6f;
    const auto last_frame = [&](const Drawing& last, bool coarse) {
      HostImage image;
      for (std::uint32_t frame = 0; frame < 8; ++frame)
        image = reconstruct({.drawing = frame == 7 ? last : drawing,
                             .raw_occlusion = raw_occlusion,
                             .tile_size = 4,
                             .previous_view = before,
                             .index = frame,
                             .coarse_depth = coarse},
                            precise(16));
      return image;
    };
    for (const bool coarse : {false, true}) {
      const HostImage plain = last_frame(drawing, coarse);
      const HostImage other = last_frame(rotated, coarse);
      double largest = 0.0;
      for (std::uint32_t y = 1; y + 1 < kHeight; ++y)
        for (std::uint32_t x = 1; x + 1 < kWidth; ++x)
          largest = std::max<double>(largest, std::abs(plain.at(x, y) - other.at(x, y)));
      SCOPED_TRACE(testing::Message() << view.name << ", coarse " << coarse);
      if (coarse)
        EXPECT_GT(largest, 0.003);
      else
        EXPECT_EQ(largest, 0.0);
    }
  }
}

TEST_F(Reconstruct, VisibilityDoesNotLeakAcrossADepthEdge) {
  for (const TestView& view : test_views()) {
    const Drawing drawing = draw(view, kWidth, kHeight, step(0.3, 1.0));
    const auto on_platform = [&](std::uint32_t x, std::uint32_t y) {
      return cast(drawing.scene, drawing.camera.ray(x + 0.5, y + 0.5))->position.z > -3.1;
    };
    const HostImage raw_occlusion = raw_occlusion_of(
        kWidth, kHeight,
        [&](std::uint32_t x, std::uint32_t y) { return on_platform(x, y) ? 0.9f : 0.2f; });
    for (const std::uint32_t history : {0u, 16u}) {
      SCOPED_TRACE(testing::Message() << view.name << ", history " << history);
      for (std::uint32_t frame = 0; frame < 4; ++frame) {
        const HostImage image = reconstruct(
            {.drawing = drawing, .raw_occlusion = raw_occlusion, .index = frame}, precise(history));
        for (std::uint32_t y = 0; y < kHeight; ++y) {
          for (std::uint32_t x = 0; x < kWidth; ++x) {
            const auto hit = cast(drawing.scene, drawing.camera.ray(x + 0.5, y + 0.5));
            if (std::abs(hit->normal.z) > 0.5) {  // the hit is not on the platform's wall
              ASSERT_NEAR(image.at(x, y), on_platform(x, y) ? 0.9f : 0.2f, 0.01)
                  << "at " << x << ", " << y;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
