#include <iostream>
#include <nlohmann/json.hpp>

#include "alcove/passes/setting_names.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "gpu_cost/budget.h"
#include "gpu_cost/cost_report.h"
#include "scene/scene.h"
#include "support/progress.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;

std::vector<passes::Quality> qualities_of(const Options& options) {
  if (options.occlusion.quality_given) {
    return {options.occlusion.quality};
  }
  return {passes::Quality::console, passes::Quality::low, passes::Quality::medium,
          passes::Quality::high};
}

tl::expected<CostInputs, std::string> inputs_of(const Options& options, passes::Quality quality) {
  OcclusionOptions one = options.occlusion;
  one.quality = quality;
  one.radius = one.radius.value_or(0.5f);  // no instruction depends on it
  const auto settings = occlusion_settings(one, Scene{});
  if (!settings) {
    return Failure(settings.error());
  }
  return CostInputs{options.view.width, options.view.height,
                    options.occlusion.normals != NormalSource::kDepth, options.cost.motion_vectors,
                    *settings};
}

tl::expected<std::vector<SettingsCost>, std::string> measure(const Options& options) {
  std::vector<SettingsCost> costs;
  for (const GpuPart& part : kGpuParts) {
    if (!options.cost.family.empty() && options.cost.family != part.family) {
      continue;
    }
    const auto device = create_null_device(part.family);
    if (!device) {
      return Failure(device.error());
    }
    for (const passes::Quality quality : qualities_of(options)) {
      const auto inputs = inputs_of(options, quality);
      if (!inputs) {
        return Failure(inputs.error());
      }
      auto frames = modelled_frames(part, *device, *inputs);
      if (!frames) {
        return Failure(std::move(frames.error()));
      }
      std::string label(passes::name_of(quality));
      for (const auto& [name, value] : options.occlusion.set) {
        label += " " + name + "=" + value;
      }
      costs.push_back({std::move(label), std::string(part.family), std::move(*frames)});
    }
  }
  return costs;
}

Done write_budget(const std::filesystem::path& file) {
  const auto device = create_null_device(kGpuParts.front().family);
  if (!device) {
    return Failure(device.error());
  }
  const auto costs = budgeted_costs();
  if (!costs) {
    return Failure(costs.error());
  }
  return write_text(file, budget_of(*costs, compiler_name(*device)).dump(1) + "\n");
}

}  // namespace

Done run_cost(const Options& options) {
  if (!options.cost.budget.empty()) {
    return write_budget(options.cost.budget);
  }
  const auto costs = measure(options);
  if (!costs) {
    return Failure(costs.error());
  }
  std::cout << table_of(*costs, options.cost.loops);
  Done written;
  if (!options.cost.json.empty()) {
    written = write_text(options.cost.json, to_json(*costs).dump(2) + "\n");
  }
  if (written && !options.cost.chart.empty()) {
    written = write_text(options.cost.chart, chart_of(*costs));
  }
  return written;
}

}  // namespace alcove::sample
