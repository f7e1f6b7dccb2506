#include "evaluate/trial_errors.h"

#include <utility>

#include "evaluate/truths.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

TrialErrors errors_of(const Trial& trial, const TrialResult& result, const Truths& truths) {
  return {trial, compare_images(result.visibility, truths.scene.visibility, truths.surfaces),
          compare_images(result.visibility, truths.height_field.visibility, truths.surfaces),
          result.cost};
}

// On a device of its own: the trial's histories begin anew.
tl::expected<TrialResult, std::string> run_trial(TrialRunner& runner, const Options& options,
                                                 const Trial& trial) {
  const auto gpu = open_gpu(options);
  if (!gpu) {
    return Failure(gpu.error());
  }
  auto result = runner.run(**gpu, trial);
  if (!result) {
    return result;
  }
  if (auto valid = check_validation(**gpu); !valid) {
    return Failure(std::move(valid.error()));
  }
  return result;
}

}  // namespace

StillSetup still_setup(const Options& options, const Camera& camera) {
  return {camera, options.view.width, options.view.height, options.view.frames,
          options.occlusion.normals};
}

tl::expected<TrialReport, std::string> run_trials(const Stage& stage, const Options& options,
                                                  const std::vector<Trial>& trials,
                                                  const std::string& progress) {
  auto runner = TrialRunner::create(*stage.gpu, stage.scene, still_setup(options, stage.camera),
                                    stage.settings);
  if (!runner) {
    return Failure(std::move(runner.error()));
  }
  const FrameImages& base = runner->base();
  const auto truths = truths_of(
      {stage.scene, stage.camera, stage.settings.radius, base.depth_ndc, base.normal_ws}, options);
  if (!truths) {
    return Failure(truths.error());
  }
  TrialReport report;
  report.rows.push_back(errors_of({"", "as it is", stage.settings},
                                  {base.visibility, {.bytes = runner->base_bytes()}}, *truths));
  const Progress print = print_progress(progress);
  for (const Trial& trial : trials) {
    const auto result = run_trial(*runner, options, trial);
    if (!result) {
      return Failure(result.error());
    }
    report.rows.push_back(errors_of(trial, *result, *truths));
    print(static_cast<double>(report.rows.size() - 1) / static_cast<double>(trials.size()));
  }
  report.base_times = runner->base_times();
  if (auto valid = check_validation(*stage.gpu); !valid) {
    return Failure(std::move(valid.error()));
  }
  return report;
}

}  // namespace alcove::sample
