#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/motion_errors.h"
#include "evaluate/motion_paths.h"
#include "evaluate/motion_walk.h"
#include "evaluate/weave.h"
#include "gpu/gpu.h"
#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// After so many frames an uncovered surface must be near as good as any.
inline constexpr std::uint32_t kUncoveredFrames = 4;

// A trail would be seen for about so long.
inline constexpr std::uint32_t kTrailFrames = 32;

// RMSE against the ray-traced truth, without its noise.
struct ErrorPair {
  std::uint64_t pixels = 0;
  double moving = 0;
  double still = 0;  // the same frames under a camera that always stood there, as many frames on

  double ratio() const { return still > 0.0 ? moving / still : 0.0; }
};

// Mean absolute change of visibility from frame to frame on a surface.
struct Flicker {
  double with_history = 0;
  double without = 0;   // of the same searches, filtered in space only
  double searches = 0;  // of the same searches, nor filtered either
  double still = 0;     // with history, when nothing moves
  double truth = 0;     // of the compared frames' truth, at least

  double ratio() const { return without > 0.0 ? with_history / without : 0.0; }
  double ratio_to_searches() const { return searches > 0.0 ? with_history / searches : 0.0; }
};

// A frame that was compared.
struct MotionPicture {
  std::uint32_t frame = 0;
  Image<float> visibility;
  Image<float> still;
  Image<float> truth;
};

struct MotionReport {
  Speed speed;  // of surfaces, mean over frames
  ErrorPair all;
  ErrorPair uncovered;     // pixels whose surface came from behind another kUncoveredFrames ago
  ErrorPair entered;       // and from beyond the border of the image
  ErrorPair passed_by;     // surfaces by which something moves, or did in the last kTrailFrames
  ErrorPair bent_normals;  // radians, on all surfaces
  Flicker flicker;
  Weave weave;         // of the moving frames
  Weave static_weave;  // of the same frames under a camera that always stood there
  std::vector<MotionPicture> pictures;
};

// Draws a path other than a cut and compares three of its frames, at a third, at two thirds and at
// the end. Flicker is taken from the first third's end on.
[[nodiscard]] tl::expected<MotionReport, std::string> run_motion(Gpu& gpu, const Scene& scene,
                                                                 const MotionPath& path,
                                                                 const MotionSetup& setup);

// The frames after a cut, 1, 2, 4 and so on of them.
struct CutErrors {
  std::uint32_t frames = 0;
  double untold = 0;   // the history must tell for itself what is another surface
  double restart = 0;  // as a first frame begins
};
struct CutReport {
  std::vector<CutErrors> after;
  std::vector<MotionPicture> pictures;  // `still` is begun anew
};
[[nodiscard]] tl::expected<CutReport, std::string> run_cut(Gpu& gpu, const Scene& scene,
                                                           const MotionPath& path,
                                                           const MotionSetup& setup);

}  // namespace alcove::sample
