#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "evaluate/recommendation.h"
#include "evaluate/static_view.h"
#include "evaluate/truths.h"
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
  [[nodiscard]] Result<std::array<double, 3>> measure(const OcclusionSettings& settings);
  // The errors with a guard band of kGuardBand of the image's height. They are not kept.
  [[nodiscard]] Result<std::array<double, 3>> measure_with_guard_band(
      const OcclusionSettings& settings) const;

  // Renders frames of an orbit that ends at the view, with `orbit` radians per frame, and returns
  // the visibility of the last one.
  [[nodiscard]] Result<Image<float>> draw(const OcclusionSettings& settings, std::uint32_t frames,
                                          float orbit);
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

// The clock of times. Modelled times are the same in every run.
enum class Clock : std::uint8_t {
  modelled,    // GPU time by the cost model (gpu_cost)
  timestamps,  // GPU time by the device's timestamps
  processor,   // processor time of all threads, for software devices
};
// Names in the order of the enumerators.
inline constexpr std::array<std::string_view, 3> kClockNames{"modelled", "timestamps", "processor"};

// Returns the times of settings in the order of Situation, in milliseconds, without or with a guard
// band of kGuardBand of the image's height.
using SettingTimes = std::function<Result<std::array<double, 3>>(const OcclusionSettings& settings,
                                                                 bool guard_band)>;

// Times that are modelled for a GPU. They are kept in the cache on disk for this build of the
// program. `inputs` are those of the view; settings are replaced. Error: Mesa's AMD driver is
// missing.
[[nodiscard]] Result<SettingTimes> modelled_times(const GpuPart& part, const CostInputs& inputs,
                                                  bool use_cache);

// Times that are measured on the session's device for images of the size of `setup`: medians over
// frames. `clock` is not `modelled`. Borrows the session. Error of a call: the device does not time
// its passes, or a rendering fails.
[[nodiscard]] SettingTimes measured_times(const Session& session, const StaticSetup& setup,
                                          Clock clock);

// Returns functions that measure settings by these errors and times, which must outlive them.
[[nodiscard]] RecommendationWorld recommendation_world(SituationErrors& errors,
                                                       const SettingTimes& times);

}  // namespace alcove::sample
