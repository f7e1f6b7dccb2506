#include "gpu_cost/budget.h"

#include <fmt/format.h>
#include <cmath>
#include <iterator>

#include "alcove/passes/setting_names.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;
using passes::Quality;

constexpr double kTolerance = 0.01;  // fraction by which instructions per pixel may exceed a budget
constexpr float kRadius = 0.5f;      // scene units; the instructions do not depend on it

LabelledSettings preset(Quality quality) {
  LabelledSettings settings;
  settings.label = passes::name_of(quality);
  settings.inputs.settings = passes::quality_settings(quality, kRadius);
  return settings;
}

Json budget_of_pass(const ModelledPass& pass) {
  return {{"instructions_per_pixel", std::ceil(10 * pass.instructions_per_pixel) / 10},
          {"vector_registers", pass.vector_registers},
          {"waves_per_simd", pass.waves_per_simd},
          {"spilled_registers", pass.spills}};
}

// A figure that must not exceed its budget or, with `at_least`, not fall below it.
struct Figure {
  const char* key;
  double value;
  double tolerance = 0;
  bool at_least = false;
};

void check(const Json& budget, const ModelledPass& pass, const std::string& where,
           std::vector<std::string>& complaints) {
  const Figure figures[] = {{"instructions_per_pixel", pass.instructions_per_pixel, kTolerance},
                            {"vector_registers", pass.vector_registers},
                            {"waves_per_simd", pass.waves_per_simd, 0, true},
                            {"spilled_registers", pass.spills}};
  for (const Figure& figure : figures) {
    const auto found = budget.find(figure.key);
    const double limit = found != budget.end() && found->is_number() ? found->get<double>() : -1.0;
    const bool fine = figure.at_least ? limit >= 0 && figure.value >= limit
                                      : figure.value <= limit * (1 + figure.tolerance);
    if (!fine) {
      complaints.push_back(fmt::format("{}: {} is {:g}, the budget is {}.", where, figure.key,
                                       figure.value,
                                       limit < 0 ? "missing" : fmt::format("{:g}", limit)));
    }
  }
}

// The object at the path `keys`, or null if there is none.
const Json& at(const Json& json, std::initializer_list<std::string> keys) {
  static const Json kNull;
  const Json* found = &json;
  for (const std::string& key : keys) {
    if (!found->is_object() || !found->contains(key)) {
      return kNull;
    }
    found = &(*found)[key];
  }
  return *found;
}

}  // namespace

std::array<LabelledSettings, 2> with_each_output(const LabelledSettings& plain) {
  LabelledSettings bent = plain;
  bent.label += " with bent normals";
  bent.inputs.settings.bent_normal = true;
  bent.label_without = plain.label;
  LabelledSettings specular = plain;
  specular.label += " with specular occlusion";
  specular.inputs.settings.specular = passes::Specular::slices;
  specular.label_without = plain.label;
  return {std::move(bent), std::move(specular)};
}

tl::expected<SettingsCost, std::string> cost_of(const GpuPart& part, const NullDevice& device,
                                                const LabelledSettings& settings) {
  auto frames = modelled_frames(part, device, settings.inputs);
  if (!frames) {
    return Failure(std::move(frames.error()));
  }
  return SettingsCost{settings.label, std::string(part.family), std::move(*frames),
                      settings.label_without};
}

std::vector<LabelledSettings> budgeted_settings() {
  std::vector<LabelledSettings> all;
  for (std::size_t i = 0; i < std::size(passes::kNames<Quality>); ++i) {
    if (const auto quality = static_cast<Quality>(i); quality != Quality::reference) {
      all.push_back(preset(quality));
    }
  }
  for (LabelledSettings& settings : with_each_output(preset(Quality::medium))) {
    all.push_back(std::move(settings));
  }
  return all;
}

tl::expected<std::vector<SettingsCost>, std::string> budgeted_costs() {
  std::vector<SettingsCost> costs;
  for (const GpuPart& part : kGpuParts) {
    const auto device = create_null_device(part.family);
    if (!device) {
      return Failure(device.error());
    }
    for (const LabelledSettings& settings : budgeted_settings()) {
      auto cost = cost_of(part, *device, settings);
      if (!cost) {
        return Failure(std::move(cost.error()));
      }
      costs.push_back(std::move(*cost));
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

Json budget_of(const std::vector<SettingsCost>& costs, const std::string& compiler) {
  Json budget;
  budget["written_by"] = "alcove cost --write-budget";
  budget["compiler"] = compiler;
  for (const SettingsCost& cost : costs) {
    for (const ModelledFrame& frame : cost.frames) {
      for (const ModelledPass& pass : frame.passes) {
        budget["passes"][cost.family][cost.label][std::string(name_of(frame.state))][pass.pass] =
            budget_of_pass(pass);
      }
    }
  }
  return budget;
}

std::vector<std::string> over_budget(const Json& budget, const std::vector<SettingsCost>& costs) {
  std::vector<std::string> complaints;
  for (const SettingsCost& cost : costs) {
    for (const ModelledFrame& frame : cost.frames) {
      const std::string state(name_of(frame.state));
      for (const ModelledPass& pass : frame.passes) {
        check(at(budget, {"passes", cost.family, cost.label, state, pass.pass}), pass,
              cost.family + ", " + cost.label + ", " + state + " frame, " + pass.pass, complaints);
      }
    }
  }
  return complaints;
}

}  // namespace alcove::sample
