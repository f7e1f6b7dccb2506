// The GPU budget: the instructions and registers of the presets as a file, which a test compares
// with the model.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites the file. A change of a pass's cost must do so in the same commit. The file has a line
// of JSON for the compiler, whose code determines the costs, then one for each pass of the settings
// on each family of GPUs.
#pragma once

#include <string>

#include "gpu_cost/cost_report.h"

namespace alcove::sample {

// Returns the text of the file for every preset except `height_field`, and for `medium` with bent
// normals and with specular occlusion.
[[nodiscard]] Result<std::string> gpu_budget();

}  // namespace alcove::sample
