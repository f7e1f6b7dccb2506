#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/motion_errors.h"
#include "evaluate/motion_paths.h"
#include "evaluate/static_view.h"
#include "evaluate/truths.h"
#include "evaluate/weave.h"
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
  TruthOptions truth;  // at least 2 rays per pixel
};

// The number of frames after which surfaces that were uncovered are measured. Their errors should
// then be nearly as small as those of other surfaces.
inline constexpr std::uint32_t kUncoveredFrames = 4;  // as in kMotionErrorTitles

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
  double static_camera = 0;    // with history, when nothing moves
  double truth = 0;            // lower bound of the change of the truth in the compared frames

  double ratio() const { return without_history > 0.0 ? with_history / without_history : 0.0; }
};

// The images of a compared frame.
struct MotionPicture {
  std::uint32_t frame = 0;
  Image<float> visibility;
  Image<float> static_camera;
  Image<float> truth;
};

// The kinds of error that are measured. Names and titles are in the order of the enumerators.
enum class MotionError : std::uint8_t {
  all,
  uncovered,     // of surfaces that another one stopped hiding kUncoveredFrames ago
  entered,       // of surfaces that entered the image kUncoveredFrames ago
  near_object,   // of surfaces that a moving object passed in the last kTrailFrames
  bent_normals,  // in degrees, on all surfaces
};
inline constexpr std::array<const char*, 5> kMotionErrorNames{
    "all", "uncovered", "entered", "near_object", "bent_normals_degrees"};
inline constexpr std::array<const char*, 5> kMotionErrorTitles{
    "whole frames", "uncovered 4 frames ago", "entered the image 4 frames ago",
    "near the moving object", "bent normals, degrees"};

// RMSE of visibility a number of frames after a cut.
struct CutErrors {
  std::uint32_t frames = 0;
  double kept = 0;       // with the history kept: the pass itself rejects samples that do not match
  double restarted = 0;  // the history is discarded at the cut
};

// The results of a path. Those of a cut are `after_cut` and the pictures only.
struct MotionReport {
  Speed speed;  // of surfaces on the image; mean over the frames
  std::array<ErrorPair, kMotionErrorNames.size()> errors;
  Flicker flicker;
  Weave weave;                       // in the frames with motion
  Weave static_weave;                // in the same views without motion
  std::vector<CutErrors> after_cut;  // after 1, 2, 4, ... frames
  // After a cut, `static_camera` holds the image of the restarted history.
  std::vector<MotionPicture> pictures;

  const ErrorPair& operator[](MotionError kind) const {
    return errors[static_cast<std::size_t>(kind)];
  }
};

// Renders a path. Unless it is a cut, three of its frames are compared with the truth: one after a
// third of the path, one after two thirds, and the last. Flicker is measured over the last two
// thirds.
[[nodiscard]] Result<MotionReport> run_motion(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                              const MotionSetup& setup);

}  // namespace alcove::sample
