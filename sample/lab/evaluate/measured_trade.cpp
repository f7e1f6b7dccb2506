#include "evaluate/measured_trade.h"

#include <fmt/format.h>
#include <algorithm>
#include <span>

#include "evaluate/situations.h"
#include "evaluate/variant.h"
#include "render/settings_json.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

using Failure = tl::unexpected<std::string>;

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

std::string table_of(const Trade& trade, const std::string& clock_title) {
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
