#include "evaluate/measured_trade.h"

#include <fmt/format.h>
#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "evaluate/situations.h"
#include "evaluate/variant.h"
#include "render/settings_json.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

using Failure = tl::unexpected<std::string>;

constexpr const GpuPart& kModelledPart = kGpuParts[1];

std::string title_of(Clock clock) {
  switch (clock) {
    case Clock::modelled:
      return "modelled time of a frame with a moving camera on " + std::string(kModelledPart.title);
    case Clock::timestamps:
      return "GPU time";
    default:
      return "processor time of all threads";
  }
}

// The point of a variant. `times` is null unless they are modelled.
Result<TradePoint> point_of(const VariantErrors& errors, const FrameTimes& base, Clock clock,
                            const ModelledTimes* times) {
  TradePoint point{errors.variant.name, errors.variant.settings, errors.scene.rmse,
                   errors.height_field.rmse};
  point.processor_ms = errors.cost.processor * base.processor_ms;
  point.bytes = errors.cost.bytes;
  if (clock == Clock::modelled) {
    ALCOVE_TRY(const auto ms, times->measure(point.settings));
    point.time_ms = ms[static_cast<std::size_t>(Situation::moving)];
  } else if (clock == Clock::timestamps) {
    point.time_ms = errors.cost.gpu * base.gpu_ms;
    point.spread_ms = errors.cost.gpu_spread * base.gpu_ms;
  } else {
    point.time_ms = point.processor_ms;
    point.spread_ms = errors.cost.processor_spread * base.processor_ms;
  }
  return point;
}

// Returns whether the device can store the filtered occlusion of half resolution, whose format is
// that of kHalfFormat in the passes. Vulkan does not require the format for storage images.
bool can_store_half_resolution(VkPhysicalDevice device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device, VK_FORMAT_R16G16B16A16_SNORM, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
}

}  // namespace

Result<MeasuredTrade> measure_trade(const Session& session, const StaticSetup& setup,
                                    const TruthOptions& truth_options,
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
  ALCOVE_TRY(const auto clock, choose_clock(device.properties(), kModelledPart, wanted));
  trade.clock = clock;
  trade.clock_title = title_of(clock);
  std::optional<ModelledTimes> times;
  if (clock == Clock::modelled) {
    ALCOVE_TRY(auto created,
               ModelledTimes::create(kModelledPart,
                                     {.width = setup.width,
                                      .height = setup.height,
                                      .normals = setup.normals != NormalSource::depth},
                                     truth_options.use_cache));
    times = std::move(created);
  }
  ALCOVE_TRY(const auto report,
             run_variants(session, setup, truth_options, variants, "trade",
                          trade.clock == Clock::modelled ? kInformativePairs : kDecidingPairs));
  for (const VariantErrors& errors : report.rows) {
    ALCOVE_TRY(auto point, point_of(errors, report.base_times, clock, times ? &*times : nullptr));
    trade.points.push_back(std::move(point));
  }
  trade.points.front().name = own_name;
  if (!std::ranges::all_of(trade.points, [](const TradePoint& p) { return p.time_ms > 0; })) {
    return Failure("The device " + std::string(device.properties().deviceName) +
                   " does not time its passes; choose another with --device.");
  }
  return trade;
}

Result<std::vector<double>> measure_grid(const Session& session, const StaticSetup& setup,
                                         const TruthOptions& truth_options) {
  ALCOVE_TRY(const auto report, run_variants(session, setup, truth_options,
                                             sampling_grid(session.settings), "grid", 0));
  std::vector<double> rmse;
  for (auto row = report.rows.begin() + 1; row != report.rows.end(); ++row)
    rmse.push_back(row->scene.rmse);
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

std::string table_of(const Trade& trade, const std::string& clock_title) {
  std::string out = fmt::format(
      "Time: {}\n"
      "{:46}scene truth   height field   time ms   spread   processor ms     MiB\n",
      clock_title, "  RMSE of visibility against");
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const TradePoint& point = trade.points[i];
    out += fmt::format("{} {:46}{:9.4f}{:15.4f}{:10.4f}{:9.4f}{:15.1f}{:8.1f}\n",
                       trade.on_pareto_front[i] ? '*' : ' ', point.name, point.rmse,
                       point.height_field_rmse, point.time_ms, point.spread_ms, point.processor_ms,
                       mib(point.bytes));
  }
  return out +
         "* Pareto front: every setting with an error as low is slower by more than the spread\n";
}

Json to_json(const Trade& trade) {
  Json list = Json::array();
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const TradePoint& point = trade.points[i];
    list.push_back({{"name", point.name},
                    {"on_pareto_front", bool(trade.on_pareto_front[i])},
                    {"rmse_scene_truth", point.rmse},
                    {"rmse_height_field_truth", point.height_field_rmse},
                    {"time_ms", point.time_ms},
                    {"spread_ms", point.spread_ms},
                    {"processor_ms", point.processor_ms},
                    {"bytes", point.bytes},
                    {"settings", to_json(point.settings)}});
  }
  return list;
}

}  // namespace alcove::sample
