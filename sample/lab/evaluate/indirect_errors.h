#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/indirect_truths.h"
#include "evaluate/truths.h"

namespace alcove::sample {

// Errors of specular occlusion for one roughness.
struct SpecularErrors {
  std::string name;          // "materials", or "r30" for a roughness of 0.30
  ErrorSummary pipeline;     // rendered specular occlusion
  ErrorSummary true_inputs;  // the rendering's model with the true visibility and bent normal
  ErrorSummary none;         // specular occlusion of 1 everywhere
};

// Errors of the multi-bounce and the specular occlusion of a rendering.
struct IndirectErrors {
  ErrorSummary bounced;          // rendered multi-bounce
  ErrorSummary bounced_truth;    // the polynomial of the true visibility
  ErrorSummary unbounced_truth;  // the true visibility without multi-bounce
  double bounced_best = 0;       // RMSE of the best function of visibility and albedo
  std::vector<SpecularErrors> specular;
};

[[nodiscard]] IndirectErrors measure_indirect_errors(const Rendering& rendering,
                                                     const Truths& truths,
                                                     const IndirectTruths& light);
// The members of `errors` in report.json: `multi_bounce` and `specular_occlusion`.
[[nodiscard]] nlohmann::ordered_json to_json(const IndirectErrors& errors);
[[nodiscard]] std::string indirect_error_table(const IndirectErrors& errors);

}  // namespace alcove::sample
