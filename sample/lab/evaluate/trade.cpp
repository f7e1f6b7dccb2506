#include "evaluate/trade.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluate/situations.h"
#include "gpu_cost/presets.h"
#include "render/settings_json.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;
using passes::OcclusionSettings;
using passes::Quality;

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
    if (!known) variants_.push_back({"", name, settings});
  }
  std::vector<Variant> take() { return std::move(variants_); }

 private:
  OcclusionSettings base_;
  std::vector<Variant> variants_;
};

std::string title_of(Clock clock, const GpuPart& part) {
  switch (clock) {
    case Clock::modelled:
      return "modelled time of a frame with a moving camera on " + std::string(part.title);
    case Clock::timestamps:
      return "GPU time";
    default:
      return "processor time of all threads";
  }
}

// Returns whether the device can store the filtered occlusion of half resolution, whose format is
// that of kHalfFormat in the passes. Vulkan does not require the format for storage images.
bool can_store_half_resolution(VkPhysicalDevice device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device, VK_FORMAT_R16G16B16A16_SNORM, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
}

}  // namespace

std::vector<Variant> preset_sweep(const OcclusionSettings& base) {
  SweepList list(base);
  for (const Quality quality : presets()) {
    const OcclusionSettings preset = passes::quality_settings(quality, base.radius);
    list.add(std::string(passes::name_of(quality)), {preset.tile_size, preset.slices, preset.steps,
                                                     preset.half_resolution, preset.depth_layers});
  }
  for (const SweepPoint& point : kSweepPoints) list.add(name_of(point), point);
  return list.take();
}

std::vector<Variant> sampling_grid(const OcclusionSettings& base) {
  std::vector<Variant> grid;
  for (const std::uint32_t steps : kGridSteps) {
    for (const std::uint32_t slices : kGridSlices) {
      OcclusionSettings settings = base;
      settings.steps = steps;
      settings.slices = slices;
      grid.push_back({"", fmt::format("{} x {}", slices, steps), settings});
    }
  }
  return grid;
}

Trade find_pareto_front(std::vector<Measurement> points) {
  // Points of equal time are ordered by error.
  std::ranges::stable_sort(points, [](const Measurement& a, const Measurement& b) {
    return std::pair(a.time_ms, a.scene.rmse) < std::pair(b.time_ms, b.scene.rmse);
  });
  Trade trade{std::move(points), {}};
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const Measurement& point = trade.points[i];
    bool on_front = true;
    for (std::size_t j = 0; j < trade.points.size() && on_front; ++j) {
      const Measurement& other = trade.points[j];
      const bool has_less_error =
          other.scene.rmse < point.scene.rmse || (other.scene.rmse == point.scene.rmse && j < i);
      on_front = j == i || !has_less_error ||
                 other.time_ms > point.time_ms + point.spread_ms + other.spread_ms;
    }
    trade.on_pareto_front.push_back(on_front);
  }
  return trade;
}

std::vector<Measurement> over_scenes(std::span<const std::vector<Measurement>> scenes) {
  std::vector<Measurement> all = scenes.front();
  const auto count = static_cast<double>(scenes.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto mean = [&](const auto& of) {
      double sum = 0;
      for (const std::vector<Measurement>& points : scenes) sum += of(points[i]);
      return sum / count;
    };
    const auto root_mean_square = [&](ErrorSummary Measurement::*errors) {
      return std::sqrt(
          mean([&](const Measurement& m) { return (m.*errors).rmse * (m.*errors).rmse; }));
    };
    all[i].scene.rmse = root_mean_square(&Measurement::scene);
    all[i].height_field.rmse = root_mean_square(&Measurement::height_field);
    for (double Measurement::*time :
         {&Measurement::time_ms, &Measurement::spread_ms, &Measurement::processor_ms})
      all[i].*time = mean([&](const Measurement& m) { return m.*time; });
    for (const std::vector<Measurement>& points : scenes)
      all[i].cost.bytes = std::max(all[i].cost.bytes, points[i].cost.bytes);
  }
  return all;
}

Result<MeasuredTrade> measure_trade(const Session& session, const StaticSetup& setup,
                                    const TruthOptions& truth_options, const GpuPart& part,
                                    std::optional<Clock> wanted) {
  std::vector<Variant> variants = preset_sweep(session.settings);
  MeasuredTrade trade;
  const VulkanDevice& device = session.gpu->device();
  if (!can_store_half_resolution(device.physical_device())) {
    std::erase_if(variants, [](const Variant& v) { return v.settings.half_resolution; });
    trade.note =
        "Settings of half resolution are left out, because the device cannot store images of the "
        "format R16G16B16A16_SNORM.\n";
  }
  // The session's own settings are rendered as the baseline of the others.
  std::string own_name = "as given";
  if (const auto own = std::ranges::find(variants, session.settings, &Variant::settings);
      own != variants.end()) {
    own_name = own->name;
    variants.erase(own);
  }
  const auto create_model = [&] {
    return ModelledTimes::create(part,
                                 {.width = setup.width,
                                  .height = setup.height,
                                  .normals = setup.normals != NormalSource::depth},
                                 truth_options.use_cache);
  };
  ALCOVE_TRY(const auto clock, choose_clock(device, create_model, wanted));
  trade.clock_title = title_of(clock.clock, part);
  ALCOVE_TRY(trade.points,
             measure_variants(session, setup, truth_options, variants, "trade", &clock));
  trade.points.front().variant.name = own_name;
  if (!std::ranges::all_of(trade.points, [](const Measurement& p) { return p.time_ms > 0; })) {
    return Failure("The device " + std::string(device.properties().deviceName) +
                   " does not time its passes; choose another with --device.");
  }
  return trade;
}

Result<std::vector<double>> measure_grid(const Session& session, const StaticSetup& setup,
                                         const TruthOptions& truth_options) {
  ALCOVE_TRY(const auto rows, measure_variants(session, setup, truth_options,
                                               sampling_grid(session.settings), "grid", nullptr));
  std::vector<double> rmse;
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) rmse.push_back(row->scene.rmse);
  return rmse;
}

std::string grid_table(const std::vector<double>& rmse) {
  std::string out = fmt::format("RMSE of visibility against scene truth\n  slices:         {:8}\n",
                                fmt::join(kGridSlices, ""));
  for (std::size_t i = 0; i < kGridSteps.size(); ++i) {
    const std::span row = std::span(rmse).subspan(i * kGridSlices.size(), kGridSlices.size());
    out += fmt::format("  {:2} steps      {:8.4f}\n", kGridSteps[i], fmt::join(row, ""));
  }
  return out;
}

std::string format_table(const Trade& trade, const std::string& clock_title) {
  std::string out = fmt::format(
      "Time: {}\n"
      "{:46}scene truth   height field   time ms   spread   processor ms     MiB\n",
      clock_title, "  RMSE of visibility against");
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const Measurement& point = trade.points[i];
    out += fmt::format("{} {:46}{:9.4f}{:15.4f}{:10.4f}{:9.4f}{:15.1f}{:8.1f}\n",
                       trade.on_pareto_front[i] ? '*' : ' ', point.variant.name, point.scene.rmse,
                       point.height_field.rmse, point.time_ms, point.spread_ms, point.processor_ms,
                       mib(point.cost.bytes));
  }
  return out +
         "* Pareto front: every setting with an error as low is slower by more than the spread\n";
}

Json to_json(const Trade& trade) {
  Json list = Json::array();
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const Measurement& point = trade.points[i];
    list.push_back({{"name", point.variant.name},
                    {"on_pareto_front", bool(trade.on_pareto_front[i])},
                    {"rmse_scene_truth", point.scene.rmse},
                    {"rmse_height_field_truth", point.height_field.rmse},
                    {"time_ms", point.time_ms},
                    {"spread_ms", point.spread_ms},
                    {"processor_ms", point.processor_ms},
                    {"bytes", point.cost.bytes},
                    {"settings", to_json(point.variant.settings)}});
  }
  return list;
}

}  // namespace alcove::sample
