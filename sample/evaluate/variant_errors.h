#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "render/session.h"

namespace alcove::sample {

// How far a variant's visibility is from both truths, and what it costs.
struct VariantErrors {
  Variant variant;
  ErrorSummary scene;
  ErrorSummary height_field;
  VariantCost cost;
};

struct VariantReport {
  std::vector<VariantErrors> rows;  // the base first, then the variants
  BaseTimes base_times;
};

// Draws the session's own settings and the variants beside them. `progress` names what is under
// way.
[[nodiscard]] tl::expected<VariantReport, std::string> run_variants(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options,
    const std::vector<Variant>& variants, const std::string& progress);

}  // namespace alcove::sample
