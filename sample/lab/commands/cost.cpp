#include <algorithm>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "alcove/passes/setting_names.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "gpu_cost/budget.h"
#include "gpu_cost/cost_report.h"
#include "scene/scene.h"
#include "support/progress.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The preset with the changes of --set. With --outputs, also with each further output.
Result<std::vector<LabelledSettings>> labelled_settings(const Options& options,
                                                        passes::Quality quality) {
  OcclusionOptions one = options.occlusion;
  one.quality = quality;
  one.radius = one.radius.value_or(0.5f);  // no instruction depends on it
  const auto settings = occlusion_settings(one, 1.0f);
  if (!settings) return Failure(settings.error());
  LabelledSettings plain{std::string(passes::name_of(quality)), options.cost.inputs, ""};
  plain.inputs.width = options.view.width;
  plain.inputs.height = options.view.height;
  plain.inputs.normals = options.occlusion.normals != NormalSource::depth;
  plain.inputs.settings = *settings;
  for (const auto& [name, value] : options.occlusion.set) plain.label += " " + name + "=" + value;
  if (!options.cost.outputs) return std::vector{std::move(plain)};
  if (settings->bent_normal || settings->specular != passes::Specular::none) {
    return Failure(
        "--outputs compares settings with and without bent normals and specular occlusion; leave "
        "bent_normal and specular out of --set.");
  }
  auto [bent, specular] = with_each_output(plain);
  return std::vector{std::move(plain), std::move(bent), std::move(specular)};
}

Result<std::vector<SettingsCost>> measure(const Options& options) {
  std::vector<LabelledSettings> settings;
  for (const passes::Quality quality : chosen_presets(options.occlusion)) {
    ALCOVE_TRY(auto all, labelled_settings(options, quality));
    std::ranges::move(all, std::back_inserter(settings));
  }
  return model_costs(settings, options.gpu);
}

Result<void> write_budget(const std::filesystem::path& file) {
  ALCOVE_TRY(const auto device, create_null_device(kGpuParts.front().family));
  ALCOVE_TRY(const auto costs, model_costs(budgeted_settings()));
  return write_text(file, format_budget(costs, device.compiler));
}

}  // namespace

Result<void> run_cost(const Options& options) {
  if (!options.cost.budget.empty()) return write_budget(options.cost.budget);
  ALCOVE_TRY(const auto costs, measure(options));
  std::cout << format_table(costs, options.cost.loops);
  if (options.cost.json.empty()) return {};
  return write_text(options.cost.json, to_json(costs).dump(2) + "\n");
}

}  // namespace alcove::sample
