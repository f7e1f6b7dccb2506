#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "evaluate/clock.h"
#include "evaluate/recommendation.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "gpu_cost/modelled_frame.h"
#include "reference/truth_cache.h"
#include "render/session.h"
#include "support/result.h"

namespace alcove::sample {

// The width of the guard bands that are measured, over the height of the image: about the length of
// a search.
inline constexpr double kGuardBand = 0.1;

// Measures the errors of settings in one view: of the first frame, of the last frame of an orbit
// that ends at the view, and after StaticSetup::frames frames of a static camera.
class SituationErrors {
 public:
  // Borrows the session. Computes the truth of the view.
  [[nodiscard]] static Result<SituationErrors> create(const Session& session,
                                                      const StaticSetup& setup,
                                                      const TruthOptions& truth_options);

  // The errors in the order of Situation. They are kept in the cache on disk, if TruthOptions allow
  // it, for this build of the program and this device.
  [[nodiscard]] Result<std::array<double, 3>> measure(const passes::OcclusionSettings& settings);
  // The errors with a guard band of kGuardBand of the image's height. They are not kept.
  [[nodiscard]] Result<std::array<double, 3>> measure_with_guard_band(
      const passes::OcclusionSettings& settings) const;

  // Renders frames of an orbit that ends at the view, with `orbit` radians per frame, and returns
  // the visibility of the last one.
  [[nodiscard]] Result<Image<float>> draw(const passes::OcclusionSettings& settings,
                                          std::uint32_t frames, float orbit);
  const Truths& truths() const { return truths_; }

 private:
  // Renders StaticSetup of a situation and returns its visibility.
  using Draw = std::function<Result<Image<float>>(const StaticSetup& setup)>;

  SituationErrors(const Session& session, const StaticSetup& setup)
      : session_(&session), setup_(setup) {}
  Result<std::array<double, 3>> compute(const Draw& draw) const;

  const Session* session_;
  StaticSetup setup_;
  std::unique_ptr<FrameRenderer> renderer_;
  Truths truths_;
  TruthCache cache_{{}};
  CacheKey key_;
};

// Models the times of settings on a GPU, and keeps them in the cache on disk for this build of the
// program.
class ModelledTimes {
 public:
  // `inputs` are those of the view; settings are replaced. Error: Mesa's AMD driver is missing.
  [[nodiscard]] static Result<ModelledTimes> create(const GpuPart& part, const CostInputs& inputs,
                                                    bool use_cache);

  // The times in the order of Situation, in milliseconds, without or with a guard band of
  // kGuardBand of the image's height.
  [[nodiscard]] Result<std::array<double, 3>> measure(const passes::OcclusionSettings& settings,
                                                      bool guard_band = false) const;

 private:
  ModelledTimes(const GpuPart& part, const CostInputs& inputs, bool use_cache)
      : part_(&part),
        inputs_(inputs),
        cache_(use_cache ? TruthCache::default_folder() : std::filesystem::path()) {}

  const GpuPart* part_;
  CostInputs inputs_;
  NullDevice device_;
  TruthCache cache_;
};

// Returns functions that measure settings by these errors and times, which must outlive them.
[[nodiscard]] RecommendationWorld recommendation_world(SituationErrors& errors,
                                                       const ModelledTimes& times);

// Returns the clock for times on a device. Without `wanted`, it is `timestamps` on a GPU; on a
// software device, whose timestamps are noise, it is `modelled`, or `processor` if Mesa's AMD
// driver is not installed. `create_model` is called if the clock is `modelled`. Error: `wanted` is
// `modelled` and the driver is not installed.
[[nodiscard]] Result<ChosenClock> choose_clock(
    const VulkanDevice& device, const std::function<Result<ModelledTimes>()>& create_model,
    std::optional<Clock> wanted);

}  // namespace alcove::sample
