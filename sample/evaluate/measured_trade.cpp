#include "evaluate/measured_trade.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "evaluate/variant_errors.h"
#include "render/settings_json.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

TradePoint point_of(const VariantErrors& errors, const BaseTimes& base) {
  return {errors.variant.name,
          errors.variant.settings,
          errors.scene.rmse,
          errors.height_field.rmse,
          errors.cost.gpu * base.gpu_ms,
          errors.cost.processor * base.processor_ms,
          errors.cost.bytes};
}

}  // namespace

tl::expected<std::vector<TradePoint>, std::string> measure_trade(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options) {
  std::vector<Variant> ways = preset_sweep(session.settings);
  // The session's own settings are drawn as what the others are timed beside.
  std::string own_name = "as given";
  if (const auto own = std::ranges::find(ways, session.settings, &Variant::settings);
      own != ways.end()) {
    own_name = own->name;
    ways.erase(own);
  }
  const auto report = run_variants(session, setup, truth_options, ways, "trade");
  if (!report) {
    return tl::unexpected(report.error());
  }
  std::vector<TradePoint> points;
  for (const VariantErrors& errors : report->rows) {
    points.push_back(point_of(errors, report->base_times));
  }
  points.front().name = own_name;
  if (!std::ranges::all_of(points, [](const TradePoint& point) { return point.gpu_ms > 0; })) {
    return tl::unexpected("The device " +
                          std::string(session.gpu->device().properties().deviceName) +
                          " does not time its passes; choose another with --device.");
  }
  return points;
}

std::string table_of(const Trade& trade) {
  std::ostringstream out;
  out << std::left << std::setw(34) << "  RMSE of visibility against" << std::right
      << "scene truth   height field    GPU ms   processor ms     MiB\n"
      << std::fixed;
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const TradePoint& point = trade.points[i];
    out << (trade.on_pareto_front[i] ? "* " : "  ") << std::left << std::setw(34) << point.name
        << std::right << std::setprecision(4) << std::setw(9) << point.rmse << std::setw(15)
        << point.height_field_rmse << std::setprecision(2) << std::setw(10) << point.gpu_ms
        << std::setw(15) << point.processor_ms << std::setprecision(1) << std::setw(8)
        << mib(point.bytes) << "\n";
  }
  return out.str() + "* nothing here is both faster and nearer to the scene's truth\n";
}

Json to_json(const Trade& trade) {
  Json list = Json::array();
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const TradePoint& point = trade.points[i];
    list.push_back({{"name", point.name},
                    {"on_pareto_front", bool(trade.on_pareto_front[i])},
                    {"rmse_scene_truth", point.rmse},
                    {"rmse_height_field_truth", point.height_field_rmse},
                    {"gpu_ms", point.gpu_ms},
                    {"processor_ms", point.processor_ms},
                    {"bytes", point.bytes},
                    {"settings", to_json(point.settings)}});
  }
  return list;
}

}  // namespace alcove::sample
