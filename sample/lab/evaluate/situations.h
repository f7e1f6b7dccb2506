#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
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

inline constexpr float kOrbit = 0.007f;  // of the moving camera, radians per frame

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
  [[nodiscard]] Result<std::array<double, 3>> measure(const Choice& choice);

  // Renders frames of an orbit that ends at the view, with `orbit` radians per frame, and returns
  // the visibility of the last one.
  [[nodiscard]] Result<Image<float>> draw(const Choice& choice, std::uint32_t frames, float orbit);
  const Truths& truths() const { return truths_; }

 private:
  SituationErrors(const Session& session, const StaticSetup& setup)
      : session_(&session), setup_(setup) {}
  Result<FrameRenderer*> renderer(double guard_band);
  Result<std::array<double, 3>> compute(const Choice& choice);

  const Session* session_;
  StaticSetup setup_;
  std::map<double, std::unique_ptr<FrameRenderer>> renderers_;  // by Choice::guard_band
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

// Returns the times of a choice in the order of Situation, in milliseconds.
using SettingTimes = std::function<Result<std::array<double, 3>>(const Choice& choice)>;

// Times that are modelled for a GPU. They are kept in the cache on disk for this build of the
// program. `inputs` are those of the view; settings are replaced. Error: Mesa's AMD driver is
// missing.
[[nodiscard]] Result<SettingTimes> modelled_times(const GpuPart& part, const CostInputs& inputs,
                                                  bool use_cache);

// Times that are measured on the session's device for images of the size of `setup`, medians over
// frames, times `scale`. `clock` is not `modelled`. Borrows the session. Error of a call: the
// device does not time its passes, or a rendering fails.
[[nodiscard]] SettingTimes measured_times(const Session& session, const StaticSetup& setup,
                                          Clock clock, double scale);

}  // namespace alcove::sample
