#include "gpu_cost/budget.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;
using passes::Quality;

constexpr double kTolerance =
    0.01;                        // relative difference of instructions per pixel that is allowed
constexpr float kRadius = 0.5f;  // scene units; the instructions do not depend on it
constexpr const char* kKeys[] = {"gpu", "settings", "pass"};

LabelledSettings preset(Quality quality) {
  LabelledSettings settings;
  settings.label = passes::name_of(quality);
  settings.inputs.settings = passes::quality_settings(quality, kRadius);
  return settings;
}

// The figures of a pass: instructions in each frame, and registers for each kind of projection.
Json budget_row(const SettingsCost& cost, const Occupancy& occupancy) {
  Json instructions = Json::array();
  for (const ModelledFrame& frame : cost.frames) {
    for (const ModelledPass& pass : frame.passes)
      if (pass.pass == occupancy.pass)
        instructions.push_back(std::ceil(10 * pass.instructions_per_pixel) / 10);
  }
  return {{"gpu", cost.part->name},
          {"settings", cost.settings.label},
          {"pass", occupancy.pass},
          {"instructions_per_pixel", std::move(instructions)},
          {"vector_registers", occupancy.vector_registers},
          {"waves_per_simd", occupancy.waves_per_simd},
          {"spilled_registers", occupancy.spills}};
}

// Compares each number of a list with its limit: `keeps(value, limit)`.
template <typename Keeps>
void check(const Json& limits, const Json& row, const char* key, const Keeps& keeps,
           std::vector<std::string>& complaints) {
  const Json& found = row[key];
  const Json limit = limits.value(key, Json::array());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double value = found[i];
    const bool known = i < limit.size() && limit[i].is_number();
    if (!known || !keeps(value, limit[i].get<double>())) {
      complaints.push_back(fmt::format(
          "{}, {}, {}: {}[{}] is {:g}, the budget is {}.", row["gpu"].get<std::string>(),
          row["settings"].get<std::string>(), row["pass"].get<std::string>(), key, i, value,
          known ? fmt::format("{:g}", limit[i].get<double>()) : "missing"));
    }
  }
}

}  // namespace

std::vector<LabelledSettings> budgeted_settings() {
  std::vector<LabelledSettings> all;
  for (const Quality quality : presets()) all.push_back(preset(quality));
  std::ranges::move(with_each_output(preset(Quality::medium)), std::back_inserter(all));
  return all;
}

std::string format_budget(const std::vector<SettingsCost>& costs, const std::string& compiler) {
  std::string lines =
      Json{{"written_by", "alcove cost --write-budget"}, {"compiler", compiler}}.dump();
  for (const SettingsCost& cost : costs)
    for (const Occupancy& occupancy : cost.occupancies)
      (lines += "\n") += budget_row(cost, occupancy).dump();
  return lines += "\n";
}

Result<std::vector<std::string>> over_budget(const std::string& budget, const std::string& compiler,
                                             const std::vector<SettingsCost>& costs) {
  std::vector<Json> rows;
  std::istringstream lines(budget);
  for (std::string line; std::getline(lines, line);)
    rows.push_back(Json::parse(line, nullptr, false));
  if (rows.empty() || !rows.front().is_object() || rows.front().value("compiler", "") != compiler) {
    return Failure("The budget was written with another compiler than " + compiler +
                   ", which makes other code.");
  }
  const auto near = [](double value, double limit) {
    return std::abs(value - limit) <= kTolerance * limit;
  };
  std::vector<std::string> complaints;
  for (const SettingsCost& cost : costs) {
    for (const Occupancy& occupancy : cost.occupancies) {
      const Json row = budget_row(cost, occupancy);
      const auto limits = std::ranges::find_if(rows, [&](const Json& other) {
        return std::ranges::all_of(kKeys, [&](const char* key) {
          return other.is_object() && other.value(key, "") == row[key];
        });
      });
      const Json none = Json::object();
      const Json& found = limits == rows.end() ? none : *limits;
      check(found, row, "instructions_per_pixel", near, complaints);
      check(found, row, "vector_registers", std::less_equal<>(), complaints);
      check(found, row, "waves_per_simd", std::greater_equal<>(), complaints);
      check(found, row, "spilled_registers", std::less_equal<>(), complaints);
    }
  }
  return complaints;
}

}  // namespace alcove::sample
