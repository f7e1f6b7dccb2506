#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "alcove/passes/setting_table.h"
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

// The preset with the changes of --set.
Result<LabelledSettings> labelled_settings(const Options& options, AlcoveQuality quality) {
  OcclusionOptions one = options.occlusion;
  one.quality = quality;
  LabelledSettings labelled{std::string(passes::kQualityNames.at(quality)), options.cost.inputs};
  ALCOVE_TRY(labelled.inputs.settings,
             occlusion_settings(one, 0.5f));  // no instruction depends on the radius
  labelled.inputs.width = options.view.width;
  labelled.inputs.height = options.view.height;
  labelled.inputs.normals = options.view.normals != NormalSource::depth;
  for (const SettingChange& change : options.occlusion.set)
    labelled.label += fmt::format(" {}", change_text(change));
  return labelled;
}

Result<std::vector<SettingsCost>> measure(const Options& options) {
  std::vector<LabelledSettings> settings;
  for (const AlcoveQuality quality : chosen_presets(options.occlusion)) {
    ALCOVE_TRY(settings.emplace_back(), labelled_settings(options, quality));
  }
  return model_costs(settings, options.gpu, options.cost.range);
}

}  // namespace

Result<void> run_cost(const Options& options) {
  if (!options.cost.budget.empty()) {
    ALCOVE_TRY_VOID(check_writable(options.cost.budget));
    ALCOVE_TRY(const auto budget, gpu_budget());
    return write_text(options.cost.budget, budget);
  }
  if (!options.cost.json.empty()) ALCOVE_TRY_VOID(check_writable(options.cost.json));
  ALCOVE_TRY(const auto costs, measure(options));
  std::cout << format_table(costs);
  if (options.cost.json.empty()) return {};
  return write_text(options.cost.json, to_json(costs).dump(2) + "\n");
}

}  // namespace alcove::sample
