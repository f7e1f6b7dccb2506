// What each part of the occlusion costs and buys: the same view drawn with one thing changed.
#ifndef ALCOVE_SAMPLE_ABLATION_H_
#define ALCOVE_SAMPLE_ABLATION_H_

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "camera.h"
#include "frame_renderer.h"
#include "gpu.h"
#include "image.h"
#include "options.h"
#include "scene.h"

namespace alcove::sample {

// One thing changed in the settings.
struct Trial {
  std::string part;  // of the occlusion, that the change is to
  std::string name;
  passes::OcclusionSettings settings;
};

// Every part of `base` exchanged or left out, none of them equal to it.
[[nodiscard]] std::vector<Trial> trials_of(const passes::OcclusionSettings& base);

// Two ways to draw one view, which should look the same.
struct Twins {
  std::string name;
  Camera first;
  Camera second;
  std::uint32_t scale = 1;  // of the second image's sides
  // Lengths, scene units: how much further away the second stands, and by how much more or less
  // the depths of a pixel may differ if it is to show one surface.
  float further = 0.0f;
  float tolerance = INFINITY;
};

// `height` of the image in pixels.
[[nodiscard]] std::vector<Twins> twins_of(const Camera& camera, std::uint32_t height);

// A standing view and how it is drawn.
struct StillSetup {
  Camera camera;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t frames = 32;  // the last of which counts, at least 1
  NormalSource normals = NormalSource::kShading;
};

// Draws the frames of a standing view and reads the last one back.
[[nodiscard]] tl::expected<FrameImages, std::string> draw_still(
    Gpu& gpu, const Scene& scene, const StillSetup& setup,
    const passes::OcclusionSettings& settings);

// What a trial costs beside the base: medians over pairs of frames, drawn one after the other.
struct TrialCost {
  double gpu = 1;           // GPU time of the occlusion over that of the base
  double processor = 1;     // processor time of all threads for it, alike
  std::uint64_t bytes = 0;  // of transients at their peak, and histories
};

struct TrialResult {
  Image<float> visibility;
  TrialCost cost;
};

// Draws trials of one view beside its base. Borrows the scene and the base's device.
class Ablation {
 public:
  [[nodiscard]] static tl::expected<Ablation, std::string> create(
      Gpu& gpu, const Scene& scene, const StillSetup& setup, const passes::OcclusionSettings& base);

  const FrameImages& base() const { return base_; }
  std::uint64_t base_bytes() const;
  // `gpu` is another device on which nothing was drawn: its histories are the trial's own.
  [[nodiscard]] tl::expected<TrialResult, std::string> run(Gpu& gpu, const Trial& trial);

 private:
  Ablation(const Scene& scene, const StillSetup& setup, const passes::OcclusionSettings& base)
      : scene_(scene), setup_(setup), settings_(base) {}

  const Scene& scene_;
  StillSetup setup_;
  passes::OcclusionSettings settings_;
  FrameImages base_;
  std::unique_ptr<FrameRenderer> renderer_;
  std::uint32_t next_frame_ = 0;  // of the base
};

}  // namespace alcove::sample

#endif  // ALCOVE_SAMPLE_ABLATION_H_
