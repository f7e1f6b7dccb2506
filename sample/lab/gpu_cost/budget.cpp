#include "gpu_cost/budget.h"

#include <algorithm>
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
Json budget_row(const GpuPart& part, const LabelledSettings& settings,
                const std::vector<ModelledFrame>& frames, const Occupancy& occupancy) {
  Json instructions = Json::array();
  for (const ModelledFrame& frame : frames) {
    for (const ModelledPass& pass : frame.passes)
      if (pass.pass == occupancy.pass)
        // Rounded up, but not because of the last bits of a sum.
        instructions.push_back(std::ceil(10 * pass.instructions_per_pixel - 1e-6) / 10);
  }
  return {{"gpu", part.family},
          {"settings", settings.label},
          {"pass", occupancy.pass},
          {"instructions_per_pixel", std::move(instructions)},
          {"vector_registers", occupancy.vector_registers},
          {"waves_per_simd", occupancy.waves_per_simd},
          {"spilled_registers", occupancy.spills}};
}

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

}  // namespace

Result<std::string> gpu_budget() {
  ALCOVE_TRY(const auto first, create_null_device(kGpuParts.front().family));
  std::string lines =
      Json{{"written_by", "alcove cost --write-budget"}, {"compiler", first.compiler}}.dump();
  for (const GpuPart& part : kGpuParts) {
    // Parts of one family run the same code.
    if (std::ranges::find(kGpuParts, part.family, &GpuPart::family) != &part) continue;
    ALCOVE_TRY(const auto device, create_null_device(part.family));
    for (const LabelledSettings& settings : budgeted_settings()) {
      ALCOVE_TRY(const auto frames, modelled_frames(part, device, settings.inputs, nullptr));
      ALCOVE_TRY(const auto found, occupancies(part, device, settings.inputs));
      for (const Occupancy& occupancy : found)
        (lines += "\n") += budget_row(part, settings, frames, occupancy).dump();
    }
  }
  return lines += "\n";
}

}  // namespace alcove::sample
