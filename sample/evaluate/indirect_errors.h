#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/indirect_truths.h"
#include "evaluate/truths.h"

namespace alcove::sample {

// How far specular occlusion of one roughness is off.
struct SpecularErrors {
  std::string name;          // materials, or r30 and the like
  ErrorSummary pipeline;     // as it was rendered
  ErrorSummary true_inputs;  // the same model given the true visibility and bent normal
  ErrorSummary none;         // with everything open
  // What the numbers of SpecularBaselines err by.
  ErrorSummary polynomials;
  ErrorSummary depth;
  ErrorSummary depth_polynomials;
};

// How far the light of a rendering is from the truth.
struct IndirectErrors {
  ErrorSummary bounced;          // multi-bounce as it was rendered
  ErrorSummary bounced_truth;    // the polynomial on the true visibility
  ErrorSummary unbounced_truth;  // the true visibility as it is
  double bounced_best = 0;       // RMSE of the best that is a function of visibility and albedo
  std::vector<SpecularErrors> specular;
};

[[nodiscard]] IndirectErrors indirect_errors_of(const Rendering& rendering, const Truths& truths,
                                                const IndirectTruths& light);
// For `errors` of report.json: the members `multi_bounce` and `specular_occlusion`.
[[nodiscard]] nlohmann::ordered_json to_json(const IndirectErrors& errors);
[[nodiscard]] std::string indirect_error_table(const IndirectErrors& errors);

}  // namespace alcove::sample
