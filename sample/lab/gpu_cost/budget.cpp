#include "gpu_cost/budget.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

constexpr float kRadius = 0.5f;  // scene units; the instructions do not depend on it

LabelledSettings preset(AlcoveQuality quality) {
  LabelledSettings settings;
  settings.label = passes::kQualityNames.at(quality);
  settings.inputs.settings = OcclusionSettings(quality, kRadius);
  return settings;
}

// The figures of a pass: instructions in each frame, and registers for each kind of projection.
Json budget_row(const SettingsCost& cost, const Occupancy& occupancy) {
  Json instructions = Json::array();
  for (const ModelledFrame& frame : cost.frames) {
    for (const ModelledPass& pass : frame.passes)
      if (pass.pass == occupancy.pass)
        // Rounded up, but not because of the last bits of a sum.
        instructions.push_back(std::ceil(10 * pass.instructions_per_pixel - 1e-6) / 10);
  }
  return {{"gpu", cost.part->name},
          {"settings", cost.settings.label},
          {"pass", occupancy.pass},
          {"instructions_per_pixel", std::move(instructions)},
          {"vector_registers", occupancy.vector_registers},
          {"waves_per_simd", occupancy.waves_per_simd},
          {"spilled_registers", occupancy.spills}};
}

}  // namespace

std::vector<LabelledSettings> budgeted_settings() {
  std::vector<LabelledSettings> all;
  for (const AlcoveQuality quality : presets()) all.push_back(preset(quality));
  LabelledSettings bent = preset(ALCOVE_QUALITY_MEDIUM);
  bent.label += " with bent normals";
  bent.inputs.settings.bent_normal = true;
  LabelledSettings specular = preset(ALCOVE_QUALITY_MEDIUM);
  specular.label += " with specular occlusion";
  specular.inputs.settings.specular = ALCOVE_SPECULAR_SLICES;
  all.insert(all.end(), {bent, specular});
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

}  // namespace alcove::sample
