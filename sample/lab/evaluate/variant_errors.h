#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "render/session.h"

namespace alcove::sample {

// The errors of a variant's visibility against both truths, and its cost.
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

// Measures the session's own settings and the variants. `progress` is the name in progress
// messages. `timed_pairs` is that of VariantRunner::run(); 0 measures no times.
[[nodiscard]] tl::expected<VariantReport, std::string> run_variants(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options,
    const std::vector<Variant>& variants, const std::string& progress,
    std::uint32_t timed_pairs = kInformativePairs);

}  // namespace alcove::sample
