// A static view rendered with changed settings, alternately with the base settings.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/clock.h"
#include "evaluate/errors.h"
#include "evaluate/truths.h"
#include "render/frame_renderer.h"
#include "render/normal_source.h"
#include "render/session.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Settings that are compared with the base settings.
struct Variant {
  std::string part;  // the part of the occlusion that was changed
  std::string name;
  passes::OcclusionSettings settings;
};

// A view and how it is rendered.
struct StaticSetup {
  Camera camera;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t frames = 32;  // at least 1; the last one is evaluated
  NormalSource normals = NormalSource::shading;
  std::uint32_t first_frame = 0;  // number of the first frame; others have another noise
  float orbit = 0;                // radians per frame, of an orbit that ends at the camera
};

// Renders the frames of a view and reads the last one back.
[[nodiscard]] Result<FrameImages> draw_frames(FrameRenderer& renderer, const StaticSetup& setup,
                                              const passes::OcclusionSettings& settings);
[[nodiscard]] Result<FrameImages> draw_static(Gpu& gpu, const Scene& scene,
                                              const StaticSetup& setup,
                                              const passes::OcclusionSettings& settings);

// Renders the frames of a view with a guard band, which is this many pixels wide beyond the borders
// at the sides, and at top and bottom, and returns the visibility of the view without the band.
[[nodiscard]] Result<Image<float>> draw_with_guard_band(Gpu& gpu, const Scene& scene,
                                                        const StaticSetup& setup,
                                                        const passes::OcclusionSettings& settings,
                                                        VkExtent2D band);

// The cost of a variant. Times are relative to the base settings.
struct VariantCost {
  double gpu = 1;           // ratio of the GPU times of the occlusion
  double processor = 1;     // ratio of the processor times of all threads
  std::uint64_t bytes = 0;  // transient images at their peak, and histories
  double gpu_spread = 0;    // of the ratios, as median_cost() defines it
  double processor_spread = 0;
};

// The times of the occlusion passes of a frame in milliseconds.
struct FrameTimes {
  double gpu_ms = 0;        // by the device's timestamps
  double processor_ms = 0;  // of all threads
};

// The times of a frame with the base settings and of a frame with a variant, drawn one after the
// other, so that other work on the machine slows both down alike.
struct TimedPair {
  FrameTimes base;
  FrameTimes variant;
};

// Returns the cost of a variant relative to the base: the median over the pairs of the ratio of its
// time to that of the base. The spread is half the distance between the quartiles of these ratios.
// Without pairs, the ratios are 1 and the spreads 0.
[[nodiscard]] VariantCost median_cost(std::span<const TimedPair> pairs, std::uint64_t bytes);

// The number of timed pairs for times that decide between settings: with 21 pairs, the quartiles
// are a confidence interval of 97 % for the median.
inline constexpr std::uint32_t kDecidingPairs = 21;

// The errors, the cost and the time of a variant in a view: a row of the tables of `ablate`,
// `bench` and `recommend`.
struct Measurement {
  Variant variant;
  ErrorSummary scene;         // of visibility against ray-traced truth
  ErrorSummary height_field;  // against brute force on the same depth buffer
  VariantCost cost;           // relative to the first row
  double time_ms = 0;         // of the occlusion passes of a frame, by the chosen clock
  double spread_ms = 0;       // of that time; 0 if it is modelled
  double processor_ms = 0;    // processor time of all threads; 0 if it was not measured
};

// The clock of a measurement's times, and the model if it is `modelled`.
struct ChosenClock {
  Clock clock = Clock::processor;
  // The modelled time of a frame with a moving camera in milliseconds.
  std::function<Result<double>(const passes::OcclusionSettings&)> model;
};

// Measures the session's own settings, which are the first row, and the variants. `progress` is the
// name in progress messages. Without a clock no times are measured.
[[nodiscard]] Result<std::vector<Measurement>> measure_variants(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options,
    const std::vector<Variant>& variants, const std::string& progress, const ChosenClock* clock);

}  // namespace alcove::sample
