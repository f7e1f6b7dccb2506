// XeGTAO's accesses through the caches of the model: the test of the constants in xegtao.h, and of
// the model itself against times that others published.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gpu_cost/cache_traffic.h"
#include "gpu_cost/xegtao.h"
#include "maths/sampling.h"

namespace alcove::sample {
namespace {

constexpr float kRadius = 96.0f / 1080.0f;  // length of a search over the height of the image
constexpr std::uint32_t kFrame = 3;

// The instructions of XeGTAO's shaders. The times of its four presets at 1920x1080 on ps4 (1.56,
// 2.21, 3.40 and 8.46 ms) and on rx6800xt (.123, .164, .243 and .560 ms) fit these terms to 1 %.
struct Arithmetic {
  double frame_ms;   // of prefilter, denoise pass and each pixel's fixed part
  double slice_ms;   // of a slice
  double sample_ms;  // of a step on both sides
  double search_waves, prefilter_waves, denoise_waves;  // in flight on a SIMD, by their registers

  double search_ms(const XeGtao& preset) const {
    return preset.slices * (slice_ms + preset.steps * sample_ms);
  }
};

Arithmetic arithmetic_of(const GpuPart& part, double size) {
  if (!part.rdna) return {.91 * size, .29 * size, .18 * size, 5, 9, 5};
  const GpuPart& counted = kGpuParts[2];
  const double slower = size * counted.simds * counted.hertz / (part.simds * part.hertz);
  return {.082 * slower, .0157 * slower, .0127 * slower, 10, 16, 10};
}

DispatchAccesses dispatch_over(std::uint32_t invocations_x, std::uint32_t invocations_y) {
  return {(invocations_x + 7) / 8, (invocations_y + 7) / 8, {}};
}

// Returns the position, 0 to 4095, of a pixel along a Hilbert curve through 64x64 pixels.
std::uint32_t hilbert_index(Texel pixel) {
  std::uint32_t x = static_cast<std::uint32_t>(pixel.x) & 63u;
  std::uint32_t y = static_cast<std::uint32_t>(pixel.y) & 63u;
  std::uint32_t index = 0;
  for (std::uint32_t size = 32; size > 0; size >>= 1u) {
    const std::uint32_t right = (x & size) != 0 ? 1 : 0;
    const std::uint32_t below = (y & size) != 0 ? 1 : 0;
    index += size * size * ((3 * right) ^ below);
    if (below == 0) {
      const std::uint32_t mirror = right * 63;
      std::swap(x, y);
      x ^= mirror;
      y ^= mirror;
    }
  }
  return index;
}

// An element of the R2 sequence, [0,1).
float r2_element(std::uint32_t index, double step) {
  const double value = 0.5 + step * index;
  return static_cast<float>(value - std::floor(value));
}

// The depth sample of a step: R2 along a Hilbert curve, and a depth level by the offset in pixels,
// or always level 0.
ImageAccess depth_sample(const PassImage& depth, const XeGtao& preset, bool levels,
                         std::uint32_t slice, float side, std::uint32_t step) {
  const float radius = kRadius * static_cast<float>(depth.height);
  const auto texel = [=](Texel pixel) {
    const std::uint32_t noise = hilbert_index(pixel) + 288 * kFrame;
    const float angle =
        maths::slice_angle(slice, preset.slices, r2_element(noise, 0.75487766624669276));
    const auto index = static_cast<float>(slice + step * preset.steps);
    const float offset = r2_element(noise, 0.56984029099805327) + index * 0.6180340f;
    const float part =
        (static_cast<float>(step) + offset - std::floor(offset)) / static_cast<float>(preset.steps);
    const float px = (part * part + maths::kNearestStep / radius) * radius;
    const float exact = levels ? std::clamp(std::log2(px) - 3.3f, 0.0f, 4.0f) : 0.0f;
    const auto level = static_cast<std::uint32_t>(std::lround(exact));
    const Texel at = along_slice(pixel, angle, side * px);
    return Texel{std::max(at.x, 0) >> level, std::max(at.y, 0) >> level, level};
  };
  return {depth, 1, texel};
}

DispatchAccesses search_accesses(const XeGtao& preset, std::uint32_t width, std::uint32_t height,
                                 bool levels = true) {
  DispatchAccesses search = dispatch_over(width, height);
  const PassImage depth{"depth levels", Direction::read, 4, width, height};
  search.accesses = {at_invocation(depth, 1, {-1, -1}, 2), at_invocation(depth, 1, {0, 0}, 2),
                     at_invocation({"normals", Direction::read, 4, width, height})};
  for (std::uint32_t slice = 0; slice < preset.slices; ++slice) {
    for (std::uint32_t step = 0; step < preset.steps; ++step)
      for (const float side : {1.0f, -1.0f})
        search.accesses.push_back(depth_sample(depth, preset, levels, slice, side, step));
  }
  search.accesses.push_back(at_invocation({"occlusion", Direction::write, 1, width, height}));
  search.accesses.push_back(at_invocation({"edges", Direction::write, 1, width, height}));
  return search;
}

// Each invocation gathers 2x2 depths, stores them, and every second, fourth and eighth stores a
// texel of the next level.
DispatchAccesses prefilter_accesses(std::uint32_t width, std::uint32_t height) {
  DispatchAccesses prefilter = dispatch_over((width + 1) / 2, (height + 1) / 2);
  prefilter.accesses.push_back(
      at_invocation({"depth", Direction::read, 4, width, height}, 2, {}, 2));
  const PassImage levels{"depth levels", Direction::write, 4, width, height};
  for (std::int32_t i = 0; i < 4; ++i)
    prefilter.accesses.push_back(at_invocation(levels, 2, {i % 2, i / 2}));
  for (std::uint32_t level = 1; level < 5; ++level) {
    prefilter.accesses.push_back(
        {levels, 1, [level](Texel invocation) {
           return Texel{invocation.x >> (level - 1), invocation.y >> (level - 1), level};
         }});
  }
  return prefilter;
}

// Each invocation computes two pixels in a row, from gathers of 2x2 texels around them.
DispatchAccesses denoise_accesses(std::uint32_t width, std::uint32_t height) {
  DispatchAccesses denoise = dispatch_over((width + 1) / 2, height);
  const auto gather = [&](const PassImage& image, std::int32_t x, std::int32_t y) {
    denoise.accesses.push_back({image, 2, [x, y](Texel invocation) {
                                  return Texel{2 * invocation.x + x, invocation.y + y};
                                }});
  };
  const PassImage edges{"edges", Direction::read, 1, width, height};
  const PassImage occlusion{"occlusion", Direction::read, 1, width, height};
  for (const Texel at : {Texel{-1, -1}, Texel{1, -1}, Texel{0, 1}}) gather(edges, at.x, at.y);
  for (const Texel at : {Texel{-1, -1}, Texel{1, -1}, Texel{-1, 1}, Texel{1, 1}})
    gather(occlusion, at.x, at.y);
  for (const std::int32_t x : {0, 1}) {
    denoise.accesses.push_back(
        {{"result", Direction::write, 1, width, height}, 1, [x](Texel invocation) {
           return Texel{2 * invocation.x + x, invocation.y};
         }});
  }
  return denoise;
}

// The time without dispatches: for each pass the longer of arithmetic and of caches and memory.
double simulated_ms(const GpuPart& part, const XeGtao& preset, std::uint32_t width,
                    std::uint32_t height) {
  const Arithmetic arithmetic = arithmetic_of(part, width * height / (1920.0 * 1080.0));
  const auto caches_ms = [&](const DispatchAccesses& dispatch, double waves) {
    return cache_traffic(part, dispatch, waves).milliseconds();
  };
  return std::max(arithmetic.search_ms(preset),
                  caches_ms(search_accesses(preset, width, height), arithmetic.search_waves)) +
         std::max(arithmetic.frame_ms,
                  caches_ms(prefilter_accesses(width, height), arithmetic.prefilter_waves) +
                      caches_ms(denoise_accesses(width, height), arithmetic.denoise_waves));
}

TEST(XeGtao, ConstantsAreThoseOfTheSimulation) {
  for (std::size_t i = 0; i < kGpuParts.size(); ++i) {
    for (const XeGtao& preset : {kXeGtao[0], kXeGtaoHigh}) {
      EXPECT_NEAR(simulated_ms(kGpuParts[i], preset, 1920, 1080) / preset.milliseconds[i], 1, 0.01)
          << kGpuParts[i].name << ", " << preset.name;
    }
  }
}

TEST(XeGtao, TimeGrowsWithTheNumberOfPixels) {
  for (const GpuPart& part : kGpuParts) {
    EXPECT_NEAR(xegtao_ms(part, kXeGtaoHigh, 3840, 2160) /
                    (simulated_ms(part, kXeGtaoHigh, 3840, 2160) + 3e3 * part.dispatch_seconds),
                1, 0.1)
        << part.name;
  }
}

// XeGTAO's README (version 1.30) gives times of High. The model's time on rx6800xt is scaled by the
// lanes and the clock (the manufacturers' boost clocks) of GPUs of other makers, so that little
// more than the order of magnitude can agree. XeGTAO computes in half precision where that is
// faster, which it says saves 5 to 20 %; the model in single precision.
TEST(PublishedTimes, XeGtaoOnOtherGpusIsWithinAFactor) {
  struct Published {
    const char* gpu;
    double lanes, hertz;
    std::uint32_t width, height;
    double ms;
  };
  constexpr Published kPublished[] = {{"RTX 2060", 1920, 1680e6, 1920, 1080, .56},
                                      {"GTX 1050", 640, 1455e6, 1920, 1080, 2.2},
                                      {"i7-1195G7", 768, 1400e6, 1920, 1080, 2.39},
                                      {"RTX 3070", 5888, 1725e6, 3840, 2160, 1.4}};
  const GpuPart& part = kGpuParts[2];
  for (const Published& published : kPublished) {
    const double lanes_per_second = 64 * part.compute_units * part.hertz;
    const double ms = xegtao_ms(part, kXeGtaoHigh, published.width, published.height) *
                      lanes_per_second / (published.lanes * published.hertz);
    std::printf("%s: %.2f ms published, %.2f modelled (%+.0f %%)\n", published.gpu, published.ms,
                ms, 100 * (ms / published.ms - 1));
    EXPECT_GT(ms, published.ms / 1.45) << published.gpu;
    EXPECT_LT(ms, published.ms * 1.45) << published.gpu;
  }
}

// The search of Bevy is XeGTAO's. On an RX 6800 XT it was timed with and without depth levels
// (github.com/bevyengine/bevy, pull request 11292). Half the width of L2 would exceed the times
// without levels by more than this test allows.
TEST(PublishedTimes, BevysSearchOnTheSameGpuIsWithinAFactor) {
  struct Published {
    std::uint32_t width, height;
    bool levels;
    double ms;
  };
  constexpr Published kPublished[] = {{1920, 1080, true, .256},
                                      {1920, 1080, false, .507},
                                      {3840, 2160, true, 1.0},
                                      {3840, 2160, false, 3.2}};
  const GpuPart& part = kGpuParts[2];
  for (const auto& [width, height, levels, published] : kPublished) {
    const Arithmetic arithmetic = arithmetic_of(part, width * height / (1920.0 * 1080.0));
    const CacheTraffic traffic = cache_traffic(
        part, search_accesses(kXeGtaoHigh, width, height, levels), arithmetic.search_waves);
    const double ms = std::max(arithmetic.search_ms(kXeGtaoHigh), traffic.milliseconds());
    std::printf("%ux%u %s levels: %.3f ms published, %.3f modelled (%+.0f %%)\n", width, height,
                levels ? "with" : "without", published, ms, 100 * (ms / published - 1));
    EXPECT_GT(ms, published / 1.6);
    EXPECT_LT(ms, published * 1.6);
  }
}

}  // namespace
}  // namespace alcove::sample
