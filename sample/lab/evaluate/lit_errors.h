#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/indirect_truths.h"
#include "render/rendering.h"
#include "support/result.h"

namespace alcove::sample {

// Error of the lit image with some parts of the occlusion applied, relative to the mean radiance of
// the truth. The noise of the truth is subtracted.
struct LitStep {
  std::string name;
  double rmse = 0;
  double bias = 0;
};
struct LitErrors {
  std::uint64_t pixels = 0;
  double mean_radiance = 0;    // of the truth
  double noise = 0;            // RMS noise of the truth over its mean radiance
  std::vector<LitStep> steps;  // each step applies one more part of the occlusion
  LitStep visibility_only;     // visibility alone, with light along the normal
  LitStep diffuse;             // diffuse part of the last step against that of the truth
  LitStep specular;            // specular part of the last step against that of the truth
};

// The rendering was made with IndirectRequest::lit_steps, and `light.lit` has a value.
[[nodiscard]] LitErrors measure_lit_errors(const Rendering& rendering, const IndirectTruths& light);
[[nodiscard]] nlohmann::ordered_json to_json(const LitErrors& errors);
[[nodiscard]] std::string lit_error_table(const LitErrors& errors);

// Writes lit_steps.png: the lit picture of each LitStep, then the one with visibility alone, the
// truth, and the error of the last step (grey for none). Also writes truth_lit.png, the truth
// alone, and lit_comparison.png: without occlusion, the last step and the truth. The images have
// one pixel for each block of pixels (IndirectTruths::block).
[[nodiscard]] Result<void> write_lit_steps(const Rendering& rendering, const IndirectTruths& light,
                                           const std::filesystem::path& folder);

}  // namespace alcove::sample
