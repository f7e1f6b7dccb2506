#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "evaluate/motion_errors.h"
#include "evaluate/motion_paths.h"
#include "evaluate/static_view.h"
#include "evaluate/truths.h"
#include "gpu/gpu.h"
#include "gpu/occlusion.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// The inputs of a run other than its path, which has the cameras and the number of frames.
struct MotionSetup {
  OcclusionSettings occlusion;  // with a history
  StaticSetup view;
  TruthOptions truth;
};

// Root mean square of an error against the ray-traced truth.
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

  double ratio() const { return without_history > 0.0 ? with_history / without_history : 0.0; }
};

// The images of a compared frame.
struct MotionPicture {
  std::uint32_t frame = 0;
  Image<float> visibility;
  Image<float> static_camera;
  Image<float> truth;
};

// The surfaces whose errors are measured. Names and titles are in the order of the enumerators.
enum class MotionError : std::uint8_t {
  all,
  uncovered,    // surfaces that came into view 4 frames ago
  near_object,  // surfaces that a moving object passed in the last 32 frames
};
inline constexpr std::array<const char*, 3> kMotionErrorNames{"all", "uncovered", "near_object"};
inline constexpr std::array<const char*, 3> kMotionErrorTitles{
    "whole frames", "in view since 4 frames", "near the moving object"};

// RMSE of visibility a number of frames after a cut.
struct CutErrors {
  std::uint32_t frames = 0;
  double kept = 0;       // with the history kept: the pass itself rejects samples that do not match
  double restarted = 0;  // the history is discarded at the cut
};

// The results of a path. Those of a cut are `after_cut` and the pictures only.
struct MotionReport {
  double speed = 0;  // of surfaces on the image, pixels per frame
  std::array<ErrorPair, kMotionErrorNames.size()> errors;
  double bent_normal_degrees = 0;         // mean angle to the truth with motion
  double static_bent_normal_degrees = 0;  // and without
  Flicker flicker;
  std::vector<CutErrors> after_cut;  // after 1, 2, 4, ... frames
  // After a cut, `static_camera` holds the image of the restarted history.
  std::vector<MotionPicture> pictures;

  const ErrorPair& operator[](MotionError kind) const {
    return errors[static_cast<std::size_t>(kind)];
  }
};

// Renders a path. Unless it is a cut, three of its frames are compared with the truth: one after a
// third of the path, one after two thirds, and the last. Speed and flicker are measured between
// each of them and the frame before. A path has at least 15 frames.
[[nodiscard]] Result<MotionReport> run_motion(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                              const MotionSetup& setup);

}  // namespace alcove::sample
