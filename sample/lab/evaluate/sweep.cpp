#include "evaluate/sweep.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <utility>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

struct SweepPoint {
  std::uint32_t tile_size, slices, steps;
  bool half_resolution = false;
};

constexpr SweepPoint kSweepPoints[] = {
    {8, 1, 4, true}, {4, 1, 8, true}, {2, 1, 10, true}, {8, 1, 8},  {4, 1, 12}, {4, 1, 24},
    {2, 1, 6},       {2, 1, 10},      {2, 1, 16},       {2, 3, 16}, {1, 1, 24}, {1, 4, 32}};

std::string name_of(const SweepPoint& s) {
  return fmt::format("{}, {} {} of {}{}",
                     s.tile_size == 1 ? "every pixel" : fmt::format("one in {0}x{0}", s.tile_size),
                     s.slices, s.slices == 1 ? "slice" : "slices", s.steps,
                     s.half_resolution ? ", half resolution" : "");
}

}  // namespace

OcclusionSettings with_samples(OcclusionSettings settings, const OcclusionSettings& samples) {
  settings.tile_size = samples.tile_size;
  settings.slices = samples.slices;
  settings.steps = samples.steps;
  settings.half_resolution = samples.half_resolution;
  return settings;
}

std::vector<Variant> preset_sweep(const OcclusionSettings& base) {
  std::vector<Variant> variants;
  const auto add = [&](std::string name, const OcclusionSettings& samples) {
    OcclusionSettings settings = with_samples(base, samples);
    settings.depth_layers = std::max(base.depth_layers, samples.depth_layers);
    if (std::ranges::find(variants, settings, &Variant::settings) == variants.end())
      variants.push_back({std::move(name), settings});
  };
  for (const AlcoveQuality quality : presets())
    add(std::string(passes::kQualityNames.at(quality)), OcclusionSettings(quality, base.radius));
  for (const SweepPoint& point : kSweepPoints) {
    OcclusionSettings samples;
    samples.tile_size = point.tile_size;
    samples.slices = point.slices;
    samples.steps = point.steps;
    samples.half_resolution = point.half_resolution ? 1 : 0;
    add(name_of(point), samples);
  }
  return variants;
}

}  // namespace alcove::sample
