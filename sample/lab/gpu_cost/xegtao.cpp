#include "gpu_cost/xegtao.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "gpu_cost/cache_traffic.h"
#include "maths/sampling.h"

namespace alcove::sample {
namespace {

constexpr double kPixels = 1920.0 * 1080.0;  // of the times below
constexpr float kRadius = 96.0f / 1080.0f;   // length of a search over the height of the image
constexpr std::uint32_t kFrame = 3;

// XeGTAO's own shaders (32-bit floats) went through this project's instruction model once. The
// times of its four presets at 1920x1080 (PS4-like 1.56, 2.21, 3.40 and 8.46 ms; RDNA2 .123, .164,
// .243 and .560 ms) fit these three terms to 1 %.
struct Arithmetic {
  double frame_ms;   // of prefilter, denoise pass and each pixel's fixed part
  double slice_ms;   // of a slice
  double sample_ms;  // of a step on both sides
  double search_waves, prefilter_waves, denoise_waves;  // in flight on a SIMD, by their registers
};

Arithmetic modelled_arithmetic(const GpuPart& part) {
  return part.rdna ? Arithmetic{.082, .0157, .0127, 10, 16, 10}
                   : Arithmetic{.91, .29, .18, 5, 9, 5};
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

// The depth sample of a step: R2 along a Hilbert curve, and a depth level by the offset in pixels.
ImageAccess depth_sample(const PassImage& depth, const XeGtao& preset, std::uint32_t slice,
                         float side, std::uint32_t step) {
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
    const auto level =
        static_cast<std::uint32_t>(std::lround(std::clamp(std::log2(px) - 3.3f, 0.0f, 4.0f)));
    const Texel at = along_slice(pixel, angle, side * px);
    return Texel{std::max(at.x, 0) >> level, std::max(at.y, 0) >> level, level};
  };
  return {depth, 1, texel};
}

DispatchAccesses search_accesses(const XeGtao& preset, std::uint32_t width, std::uint32_t height) {
  DispatchAccesses search = dispatch_over(width, height);
  const PassImage depth{"depth levels", Direction::read, 4, width, height};
  search.accesses = {at_invocation(depth, 1, {-1, -1}, 2), at_invocation(depth, 1, {0, 0}, 2),
                     at_invocation({"normals", Direction::read, 4, width, height})};
  for (std::uint32_t slice = 0; slice < preset.slices; ++slice) {
    for (std::uint32_t step = 0; step < preset.steps; ++step)
      for (const float side : {1.0f, -1.0f})
        search.accesses.push_back(depth_sample(depth, preset, slice, side, step));
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

}  // namespace

double xegtao_ms(const GpuPart& part, const XeGtao& preset, std::uint32_t width,
                 std::uint32_t height) {
  // Tables ask for the same frames again and again.
  static std::map<std::tuple<std::string_view, std::string_view, std::uint32_t, std::uint32_t>,
                  double>
      known;
  double& ms = known[{part.family, preset.name, width, height}];
  if (ms > 0) return ms;
  const Arithmetic arithmetic = modelled_arithmetic(part);
  const auto caches_ms = [&](const DispatchAccesses& dispatch, double waves) {
    return cache_ms(part, cache_traffic(part, dispatch, waves));
  };
  const double size = width * static_cast<double>(height) / kPixels;
  const double search_ms =
      preset.slices * (arithmetic.slice_ms + preset.steps * arithmetic.sample_ms) * size;
  ms = std::max(search_ms,
                caches_ms(search_accesses(preset, width, height), arithmetic.search_waves)) +
       std::max(arithmetic.frame_ms * size,
                caches_ms(prefilter_accesses(width, height), arithmetic.prefilter_waves) +
                    caches_ms(denoise_accesses(width, height), arithmetic.denoise_waves)) +
       3e3 * part.dispatch_seconds;
  return ms;
}

}  // namespace alcove::sample
