#include "evaluate/sweep.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

// The settings that differ between the points of a sweep.
struct SweepPoint {
  std::uint32_t tile_size;
  std::uint32_t slices;
  std::uint32_t steps;
  bool half_resolution = false;
  std::uint32_t depth_layers = 1;
};

constexpr std::array<SweepPoint, 21> kSweepPoints{
    {{8, 1, 4, true}, {8, 1, 16, true}, {4, 1, 8, true}, {4, 1, 16, true}, {2, 1, 10, true},
     {8, 1, 8},       {4, 1, 4},        {4, 1, 12},      {4, 1, 24},       {2, 1, 4},
     {2, 1, 6},       {2, 1, 10},       {4, 3, 12},      {2, 1, 16},       {2, 1, 24},
     {2, 3, 16},      {2, 2, 10},       {1, 1, 12},      {1, 1, 24},       {1, 2, 24},
     {1, 4, 32}}};

std::string name_of(const SweepPoint& s) {
  return fmt::format("{}, {} {} of {}{}",
                     s.tile_size == 1 ? "every pixel" : fmt::format("one in {0}x{0}", s.tile_size),
                     s.slices, s.slices == 1 ? "slice" : "slices", s.steps,
                     s.half_resolution ? ", half resolution" : "");
}

class SweepList {
 public:
  explicit SweepList(const OcclusionSettings& base) : base_(base) {}

  void add(const std::string& name, const SweepPoint& point) {
    OcclusionSettings settings = base_;
    settings.tile_size = point.tile_size;
    settings.slices = point.slices;
    settings.steps = point.steps;
    settings.half_resolution = point.half_resolution;
    settings.depth_layers = std::max(base_.depth_layers, point.depth_layers);
    const bool known = std::ranges::any_of(
        variants_, [&](const Variant& variant) { return variant.settings == settings; });
    if (!known) variants_.push_back({name, settings});
  }
  std::vector<Variant> take() { return std::move(variants_); }

 private:
  OcclusionSettings base_;
  std::vector<Variant> variants_;
};

}  // namespace

std::vector<Variant> preset_sweep(const OcclusionSettings& base) {
  SweepList list(base);
  for (const AlcoveQuality quality : presets()) {
    const OcclusionSettings preset = OcclusionSettings(quality, base.radius);
    list.add(std::string(passes::kQualityNames.at(quality)),
             {preset.tile_size, preset.slices, preset.steps, preset.half_resolution != 0,
              preset.depth_layers});
  }
  for (const SweepPoint& point : kSweepPoints) list.add(name_of(point), point);
  return list.take();
}

}  // namespace alcove::sample
