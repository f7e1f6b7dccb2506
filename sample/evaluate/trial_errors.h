#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/trial.h"
#include "cli/options.h"
#include "render/stage.h"

namespace alcove::sample {

// How far a trial's visibility is from both truths, and what it costs.
struct TrialErrors {
  Trial trial;
  ErrorSummary scene;
  ErrorSummary height_field;
  TrialCost cost;
};

struct TrialReport {
  std::vector<TrialErrors> rows;  // the base first, then the trials
  BaseTimes base_times;
};

// The standing view of the options.
[[nodiscard]] StillSetup still_setup(const Options& options, const Camera& camera);

// Draws the stage's own settings and the trials beside them. `progress` names what is under way.
[[nodiscard]] tl::expected<TrialReport, std::string> run_trials(const Stage& stage,
                                                                const Options& options,
                                                                const std::vector<Trial>& trials,
                                                                const std::string& progress);

}  // namespace alcove::sample
