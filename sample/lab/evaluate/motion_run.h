#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/motion_errors.h"
#include "evaluate/motion_paths.h"
#include "evaluate/weave.h"
#include "gpu/gpu.h"
#include "render/normal_source.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

// The inputs of a run other than its path.
struct MotionSetup {
  passes::OcclusionSettings occlusion;  // with a history
  NormalSource normals = NormalSource::shading;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t spp = 256;                        // rays per pixel of the truth, at least 2
  std::filesystem::path cache;                    // folder of cached truths; empty: no cache
  std::function<Progress(std::string)> progress;  // makes the progress of a named task; may be null
};

// The number of frames after which surfaces that were uncovered are measured. Their errors should
// then be nearly as small as those of other surfaces.
inline constexpr std::uint32_t kUncoveredFrames = 4;

// Surfaces that a moving object passed within this many last frames are measured separately,
// because a history could leave a trail of the object there for that long.
inline constexpr std::uint32_t kTrailFrames = 32;

// RMSE of visibility against the ray-traced truth; the noise of the truth is subtracted.
struct ErrorPair {
  std::uint64_t pixels = 0;
  double moving = 0;
  double static_camera = 0;  // for the same view after as many frames without motion

  double ratio() const { return static_camera > 0.0 ? moving / static_camera : 0.0; }
};

// Mean absolute change of visibility between two frames at the same surface point.
struct Flicker {
  double with_history = 0;
  double without_history = 0;  // after the spatial filter alone
  double raw = 0;              // raw occlusion, without either filter
  double static_camera = 0;    // with history, when nothing moves
  double truth = 0;            // lower bound of the change of the truth in the compared frames

  double ratio() const { return without_history > 0.0 ? with_history / without_history : 0.0; }
  double ratio_to_raw() const { return raw > 0.0 ? with_history / raw : 0.0; }
};

// The images of a compared frame.
struct MotionPicture {
  std::uint32_t frame = 0;
  Image<float> visibility;
  Image<float> static_camera;
  Image<float> truth;
};

struct MotionReport {
  Speed speed;  // of surfaces on the image; mean over the frames
  ErrorPair all;
  ErrorPair uncovered;     // surfaces that another one stopped hiding kUncoveredFrames ago
  ErrorPair entered;       // surfaces that entered the image kUncoveredFrames ago
  ErrorPair near_object;   // surfaces that a moving object passed in the last kTrailFrames
  ErrorPair bent_normals;  // radians, on all surfaces
  Flicker flicker;
  Weave weave;         // in the frames with motion
  Weave static_weave;  // in the same views without motion
  std::vector<MotionPicture> pictures;
};

// Renders a path other than a cut. Three of its frames are compared with the truth: one after a
// third of the path, one after two thirds, and the last. Flicker is measured over the last two
// thirds.
[[nodiscard]] Result<MotionReport> run_motion(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                              const MotionSetup& setup);

// RMSE of visibility a number of frames after a cut.
struct CutErrors {
  std::uint32_t frames = 0;
  double kept = 0;       // with the history kept: the pass itself rejects samples that do not match
  double restarted = 0;  // the history is discarded at the cut
};
struct CutReport {
  std::vector<CutErrors> after;         // after 1, 2, 4, ... frames
  std::vector<MotionPicture> pictures;  // `static_camera` holds the image of the restarted history
};
[[nodiscard]] Result<CutReport> run_cut(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                        const MotionSetup& setup);

}  // namespace alcove::sample
