#pragma once

#include <cstdint>
#include <functional>

#include "evaluate/errors.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// A rendered frame of a path; all images have the same size.
struct RenderedFrame {
  Camera camera;
  Image<float> depth;  // linear; infinity: sky
  Image<glm::vec3> normal_ws;
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;
};

// Where the surfaces of a frame were on the image of the previous frame.
struct Reprojection {
  Image<glm::vec2> position_px;  // from the top left corner; may lie outside the image
  // Which of the four texels around position_px (x first, then y) show the same surface: bit i is
  // set if texel i lies within 0.5 % of the depth from the surface's tangent plane. 0 in the sky.
  Image<std::uint8_t> texels;
};
inline constexpr std::uint8_t kAllTexels = 0xf;

// `position_before` gives the world-space position, one frame earlier, of a point of this frame.
using PositionBefore = std::function<glm::vec3(const glm::vec3& position_ws)>;
[[nodiscard]] Reprojection reproject(const RenderedFrame& now, const RenderedFrame& before,
                                     const PositionBefore& position_before);

// For how long the surface of a pixel has been visible.
struct Age {
  std::uint32_t frames = 0;  // consecutive frames, this one included; 0 in the sky
  bool uncovered = false;    // it was hidden by another surface before, not outside the image
};
// The ages in the first frame, and in a later frame from those of the frame before.
[[nodiscard]] Image<Age> first_ages(const RenderedFrame& now);
[[nodiscard]] Image<Age> next_ages(const RenderedFrame& now, const Reprojection& reprojection,
                                   const Image<Age>& before);

// A mean over the pixels of many frames.
struct RunningMean {
  double sum = 0;
  std::uint64_t count = 0;

  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
  RunningMean& operator+=(const RunningMean& more);
};

// Returns the mean absolute change of visibility from the previous frame to this one, over the
// pixels whose four previous texels all show the same surface. The previous frame is read
// bilinearly at the position that the surface had.
[[nodiscard]] RunningMean visibility_change(const Image<float>& now, const Image<float>& before,
                                            const Reprojection& reprojection);

// The pixels with a surface for which `choose` returns true.
[[nodiscard]] Mask surfaces_where(const RenderedFrame& seen,
                                  const std::function<bool(const glm::vec3& position_ws)>& choose);

// Speed of the surfaces that move on the image, in pixels per frame; zero if none moves.
struct Speed {
  double mean = 0;
  double percentile_95 = 0;
};
[[nodiscard]] Speed measure_speed(const Reprojection& reprojection);

// A ray-traced image in two halves with independent rays, whose difference gives its noise.
template <class T>
struct SplitTruth {
  Image<T> first;
  Image<T> second;
};
[[nodiscard]] Image<float> mean_image(const SplitTruth<float>& truth);

// Returns a lower bound of visibility_change() for a truth that is traced in two halves. The change
// in each half is counted with the sign of the change in the other half, so that noise adds nothing
// to the mean.
[[nodiscard]] RunningMean change_lower_bound(const SplitTruth<float>& now,
                                             const SplitTruth<float>& before,
                                             const Reprojection& reprojection);

// Returns the squared error of a result against the mean of the two halves, minus the variance of
// that mean. It may be slightly negative by chance if there is no error.
[[nodiscard]] RunningMean squared_error(const Image<float>& result, const SplitTruth<float>& truth,
                                        const Mask& mask);
// Returns the squared error of directions: the squared length of the difference of the unit
// vectors, which for small angles is the squared angle. A missing direction counts as 90 degrees.
[[nodiscard]] RunningMean squared_error(const Image<glm::vec3>& result,
                                        const SplitTruth<glm::vec3>& truth, const Mask& mask);
// The root of a mean of squared errors; 0 if the mean is negative.
[[nodiscard]] double root(const RunningMean& squares);

}  // namespace alcove::sample
