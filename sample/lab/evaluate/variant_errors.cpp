#include "evaluate/variant_errors.h"

#include <utility>

#include "evaluate/truths.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

VariantErrors errors_of(const Variant& variant, const VariantResult& result, const Truths& truths) {
  return {variant, compare_images(result.visibility, truths.scene.visibility, truths.surfaces),
          compare_images(result.visibility, truths.height_field.visibility, truths.surfaces),
          result.cost};
}

// Runs a variant on a device of its own, so that its histories start empty.
tl::expected<VariantResult, std::string> run_variant(VariantRunner& runner,
                                                     const DeviceRequest& device,
                                                     const Variant& variant,
                                                     std::uint32_t timed_pairs) {
  const auto gpu = open_gpu(device);
  if (!gpu) {
    return Failure(gpu.error());
  }
  auto result = runner.run(**gpu, variant, timed_pairs);
  if (!result) {
    return result;
  }
  if (auto valid = check_validation(**gpu); !valid) {
    return Failure(std::move(valid.error()));
  }
  return result;
}

}  // namespace

tl::expected<VariantReport, std::string> run_variants(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options,
    const std::vector<Variant>& variants, const std::string& progress, std::uint32_t timed_pairs) {
  auto runner = VariantRunner::create(*session.gpu, session.scene, setup, session.settings);
  if (!runner) {
    return Failure(std::move(runner.error()));
  }
  const FrameImages& base = runner->base();
  const auto truths = truths_of(
      {session.scene, setup.camera, session.settings.radius, base.depth_ndc, base.normal_ws},
      truth_options);
  if (!truths) {
    return Failure(truths.error());
  }
  VariantReport report;
  report.rows.push_back(errors_of({"", "base settings", session.settings},
                                  {base.visibility, {.bytes = runner->base_bytes()}}, *truths));
  const Progress print = print_progress(progress);
  for (const Variant& variant : variants) {
    const auto result = run_variant(*runner, session.device, variant, timed_pairs);
    if (!result) {
      return Failure(result.error());
    }
    report.rows.push_back(errors_of(variant, *result, *truths));
    print(static_cast<double>(report.rows.size() - 1) / static_cast<double>(variants.size()));
  }
  report.base_times = runner->base_times();
  if (auto valid = check_validation(*session.gpu); !valid) {
    return Failure(std::move(valid.error()));
  }
  return report;
}

}  // namespace alcove::sample
