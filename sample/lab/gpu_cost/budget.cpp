#include "gpu_cost/budget.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;
using passes::Quality;

constexpr float kRadius = 0.5f;  // scene units; the instructions do not depend on it

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
  for (const Quality quality : presets()) all.push_back(preset(quality));
  LabelledSettings bent = preset(Quality::medium);
  bent.label += " with bent normals";
  bent.inputs.settings.bent_normal = true;
  LabelledSettings specular = preset(Quality::medium);
  specular.label += " with specular occlusion";
  specular.inputs.settings.specular = passes::Specular::slices;
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
