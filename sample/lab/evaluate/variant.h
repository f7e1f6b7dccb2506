// A static view rendered with changed settings, alternately with the base settings.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"
#include "render/frame_renderer.h"
#include "render/normal_source.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"

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
[[nodiscard]] tl::expected<FrameImages, std::string> draw_frames(
    FrameRenderer& renderer, const StaticSetup& setup, const passes::OcclusionSettings& settings);
[[nodiscard]] tl::expected<FrameImages, std::string> draw_static(
    Gpu& gpu, const Scene& scene, const StaticSetup& setup,
    const passes::OcclusionSettings& settings);

// The cost of a variant. Times are relative to the base settings.
struct VariantCost {
  double gpu = 1;           // ratio of the GPU times of the occlusion
  double processor = 1;     // ratio of the processor times of all threads
  std::uint64_t bytes = 0;  // transient images at their peak, and histories
  double gpu_spread = 0;    // of the ratios, as cost_of() defines it
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
[[nodiscard]] VariantCost cost_of(std::span<const TimedPair> pairs, std::uint64_t bytes);

// Two numbers of timed pairs. kDecidingPairs is for times that decide between settings: with 21
// pairs, the quartiles are a confidence interval of 97 % for the median. Times that are only
// printed need fewer pairs.
inline constexpr std::uint32_t kDecidingPairs = 21;
inline constexpr std::uint32_t kInformativePairs = 11;

struct VariantResult {
  Image<float> visibility;
  VariantCost cost;
};

// Median times of the base's occlusion over the timed frames.
struct BaseTimes {
  double gpu_ms = 0;
  double processor_ms = 0;
};

// Renders variants of a view alternately with its base. Borrows the scene and the base's device.
class VariantRunner {
 public:
  [[nodiscard]] static tl::expected<VariantRunner, std::string> create(
      Gpu& gpu, const Scene& scene, const StaticSetup& setup,
      const passes::OcclusionSettings& base);

  const FrameImages& base() const { return base_; }
  std::uint64_t base_bytes() const;
  // Medians over all variants so far; zero before the first.
  BaseTimes base_times() const;
  // Renders a variant and measures its times relative to the base. `gpu` must be a device that did
  // not render the base or another variant, because it keeps the history of its frames.
  // `timed_pairs` pairs of frames are timed, each with a frame of the base and a frame of the
  // variant. With 0 pairs, only the image and the bytes are measured.
  [[nodiscard]] tl::expected<VariantResult, std::string> run(
      Gpu& gpu, const Variant& variant, std::uint32_t timed_pairs = kInformativePairs);

 private:
  VariantRunner(const Scene& scene, const StaticSetup& setup, const passes::OcclusionSettings& base)
      : scene_(scene), setup_(setup), settings_(base) {}

  const Scene& scene_;
  StaticSetup setup_;
  passes::OcclusionSettings settings_;
  FrameImages base_;
  std::unique_ptr<FrameRenderer> renderer_;
  std::uint32_t next_frame_ = 0;  // the next frame index of the base
  std::vector<double> base_gpu_ms_;
  std::vector<double> base_processor_ms_;
};

}  // namespace alcove::sample
