#pragma once

#include <cstdint>
#include <functional>

#include "evaluate/errors.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// A frame of a path as the next one is told from: all images of one size.
struct SeenFrame {
  Camera camera;
  Image<float> depth;  // linear; infinity: sky
  Image<glm::vec3> normal_ws;
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;
};

// Where the surfaces of a frame were on the image of the frame before.
struct Retraced {
  Image<glm::vec2> position_px;  // there, from the top left corner; not confined to the image
  // Bit i is set where texel i of the four around it (x first, then y) shows the same surface: lies
  // within half a hundredth of the depth of its tangent plane. 0 in the sky.
  Image<std::uint8_t> texels;
};
inline constexpr std::uint8_t kAllTexels = 0xf;

// `position_before` says where a point of this frame was, in world space.
using PositionBefore = std::function<glm::vec3(const glm::vec3& position_ws)>;
[[nodiscard]] Retraced retrace(const SeenFrame& now, const SeenFrame& before,
                               const PositionBefore& position_before);

// How long a pixel's surface has been seen.
struct Age {
  std::uint32_t frames = 0;  // in a row, this one included; 0 in the sky
  bool uncovered = false;    // it came from behind something, not from beyond the image
};
// Of the first frame, and of the next by that of the frame before.
[[nodiscard]] Image<Age> first_ages(const SeenFrame& now);
[[nodiscard]] Image<Age> next_ages(const SeenFrame& now, const Retraced& retraced,
                                   const Image<Age>& before);

// A mean over pixels of many frames.
struct RunningMean {
  double sum = 0;
  std::uint64_t count = 0;

  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
  RunningMean& operator+=(const RunningMean& more);
};

// Absolute change of an image of visibility since the frame before, where all four texels are the
// surface's, read there bilinearly.
[[nodiscard]] RunningMean visibility_change(const Image<float>& now, const Image<float>& before,
                                            const Retraced& retraced);

// Where surfaces are of which `choose` says so.
[[nodiscard]] Mask surfaces_where(const SeenFrame& seen,
                                  const std::function<bool(const glm::vec3& position_ws)>& choose);

// Of the surfaces that move on the image, in pixels of a frame; zero where none does.
struct Speed {
  double mean = 0;
  double percentile_95 = 0;
};
[[nodiscard]] Speed speed_of(const Retraced& retraced);

// A ray-traced image in two halves of other rays, whose difference tells its noise.
template <class T>
struct Halves {
  Image<T> first;
  Image<T> second;
};
[[nodiscard]] Image<float> mean_of(const Halves<float>& truth);

// The same change of a truth, at least: each half is counted in the direction that the other tells,
// so that noise adds nothing in the mean.
[[nodiscard]] RunningMean least_change(const Halves<float>& now, const Halves<float>& before,
                                       const Retraced& retraced);

// Squared error against the mean of the halves, less what its noise adds. The mean may come out
// below 0 by chance where there is no error.
[[nodiscard]] RunningMean squared_error(const Image<float>& result, const Halves<float>& truth,
                                        const Mask& mask);
// The same of unit directions: the squared chord between them, which of small angles is the angle's
// square. No direction counts as one across.
[[nodiscard]] RunningMean squared_error(const Image<glm::vec3>& result,
                                        const Halves<glm::vec3>& truth, const Mask& mask);
// The root of a mean of squared errors; 0 of one below 0.
[[nodiscard]] double root(const RunningMean& squares);

}  // namespace alcove::sample
