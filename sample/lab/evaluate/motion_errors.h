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
};

// Where the surfaces of a frame were on the image of an earlier frame.
struct Reprojection {
  Image<glm::vec2> position_px;  // from the top left corner; may lie outside the image
  // Which of the four texels around position_px (x first, then y) show the same surface: bit i is
  // set if texel i lies within 0.5 % of the depth from the surface's tangent plane. 0 in the sky.
  Image<std::uint8_t> texels;
};
inline constexpr std::uint8_t kAllTexels = 0xf;

// `position_before` gives the world-space position in the earlier frame of a point of this frame.
using PositionBefore = std::function<glm::vec3(const glm::vec3& position_ws)>;
[[nodiscard]] Reprojection reproject(const RenderedFrame& now, const RenderedFrame& before,
                                     const PositionBefore& position_before);

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

// The speed of the surfaces that move on the image, in pixels per frame.
[[nodiscard]] RunningMean measure_speed(const Reprojection& reprojection);

}  // namespace alcove::sample
