// A standing view drawn under changed settings, side by side with the settings as they were.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "render/frame_renderer.h"
#include "gpu/gpu.h"
#include "render/normal_source.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// Settings to draw with beside others.
struct Variant {
  std::string part;  // of the occlusion, that the change is to
  std::string name;
  passes::OcclusionSettings settings;
};

// A standing view and how it is drawn.
struct StaticSetup {
  Camera camera;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t frames = 32;  // the last of which counts, at least 1
  NormalSource normals = NormalSource::kShading;
};

// Draws the frames of a standing view and reads the last one back.
[[nodiscard]] tl::expected<FrameImages, std::string> draw_static(
    Gpu& gpu, const Scene& scene, const StaticSetup& setup,
    const passes::OcclusionSettings& settings);

// What a variant costs beside the base: medians over pairs of frames, drawn one after the other.
// The spreads are half of the distance between the quartiles of the same ratios.
struct VariantCost {
  double gpu = 1;           // GPU time of the occlusion over that of the base
  double processor = 1;     // processor time of all threads for it, alike
  std::uint64_t bytes = 0;  // of transients at their peak, and histories
  double gpu_spread = 0;
  double processor_spread = 0;
};

struct VariantResult {
  Image<float> visibility;
  VariantCost cost;
};

// Milliseconds of the occlusion, medians over the frames that were timed.
struct BaseTimes {
  double gpu_ms = 0;
  double processor_ms = 0;
};

// Draws variants of one view beside its base. Borrows the scene and the base's device.
class VariantRunner {
 public:
  [[nodiscard]] static tl::expected<VariantRunner, std::string> create(
      Gpu& gpu, const Scene& scene, const StaticSetup& setup,
      const passes::OcclusionSettings& base);

  const FrameImages& base() const { return base_; }
  std::uint64_t base_bytes() const;
  // Over all variants so far; nothing before the first.
  BaseTimes base_times() const;
  // `gpu` is another device on which nothing was drawn: its histories are the variant's own.
  // Without `timed` only the image is drawn, and the cost is left at its defaults but for the
  // bytes.
  [[nodiscard]] tl::expected<VariantResult, std::string> run(Gpu& gpu, const Variant& variant,
                                                             bool timed = true);

 private:
  VariantRunner(const Scene& scene, const StaticSetup& setup, const passes::OcclusionSettings& base)
      : scene_(scene), setup_(setup), settings_(base) {}

  const Scene& scene_;
  StaticSetup setup_;
  passes::OcclusionSettings settings_;
  FrameImages base_;
  std::unique_ptr<FrameRenderer> renderer_;
  std::uint32_t next_frame_ = 0;  // of the base
  std::vector<double> base_gpu_ms_;
  std::vector<double> base_processor_ms_;
};

}  // namespace alcove::sample
