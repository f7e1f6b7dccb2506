#include "gpu_cost/budget.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
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
Json row_of(const SettingsCost& cost, const Occupancy& occupancy) {
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

enum class Bound { at_most, at_least, near };

bool keeps(Bound bound, double value, double limit) {
  switch (bound) {
    case Bound::at_most:
      return value <= limit;
    case Bound::at_least:
      return value >= limit;
    case Bound::near:
      return std::abs(value - limit) <= kTolerance * limit;
  }
  return false;
}

// Compares each number of a list with its limit.
void check(const Json& limits, const Json& row, const char* key, Bound bound,
           std::vector<std::string>& complaints) {
  const Json& found = row[key];
  const Json limit = limits.value(key, Json::array());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double value = found[i];
    const bool known = i < limit.size() && limit[i].is_number();
    if (!known || !keeps(bound, value, limit[i].get<double>())) {
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

Result<std::vector<SettingsCost>> budgeted_costs() {
  std::vector<SettingsCost> costs;
  for (const GpuPart& part : kGpuParts) {
    ALCOVE_TRY(const auto device, create_null_device(part.family));
    for (const LabelledSettings& settings : budgeted_settings()) {
      ALCOVE_TRY(auto cost, cost_of(part, device, settings));
      costs.push_back(std::move(cost));
    }
  }
  return costs;
}

std::string compiler_name(const NullDevice& device) {
  VkPhysicalDeviceDriverProperties driver{.sType =
                                              VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device.physical_device, &properties);
  return std::string(driver.driverName) + ", " + driver.driverInfo;
}

std::string budget_of(const std::vector<SettingsCost>& costs, const std::string& compiler) {
  std::string lines =
      Json{{"written_by", "alcove cost --write-budget"}, {"compiler", compiler}}.dump();
  for (const SettingsCost& cost : costs)
    for (const Occupancy& occupancy : cost.occupancies)
      (lines += "\n") += row_of(cost, occupancy).dump();
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
  std::vector<std::string> complaints;
  for (const SettingsCost& cost : costs) {
    for (const Occupancy& occupancy : cost.occupancies) {
      const Json row = row_of(cost, occupancy);
      const auto limits = std::ranges::find_if(rows, [&](const Json& other) {
        return std::ranges::all_of(kKeys, [&](const char* key) {
          return other.is_object() && other.value(key, "") == row[key];
        });
      });
      const Json none = Json::object();
      const Json& found = limits == rows.end() ? none : *limits;
      check(found, row, "instructions_per_pixel", Bound::near, complaints);
      check(found, row, "vector_registers", Bound::at_most, complaints);
      check(found, row, "waves_per_simd", Bound::at_least, complaints);
      check(found, row, "spilled_registers", Bound::at_most, complaints);
    }
  }
  return complaints;
}

}  // namespace alcove::sample
