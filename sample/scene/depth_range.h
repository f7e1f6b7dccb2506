#pragma once

#include <optional>

#include "scene/scene.h"

namespace alcove::sample {

// Distances along the view direction, from the plane through the eye. In orthographic views they
// may be negative.
struct DepthRange {
  double nearest;
  double farthest;
};

// The depth range of the triangles within the image. `aspect` is its width over its height.
// Perspective views leave out triangles behind the eye. Null if nothing is in view.
//
// The range is exact as long as the instances whose bounds could change it have fewer than 2^25
// triangles together. Beyond that their bounds count, so that the range is too wide at most.
[[nodiscard]] std::optional<DepthRange> depth_in_view(const Scene& scene, const Camera& camera,
                                                      double aspect);

// Fits the planes of a camera to the triangles in view. Unchanged if nothing is in view.
//
// Perspective: the near plane is at half the distance of the nearest triangle in view, and from
// 1/5000 to 1/100 of the diagonal of the scene's core. The far plane is behind the farthest
// triangle in view, and behind the core for every position and direction of the camera within the
// core. Orthographic: the planes enclose the triangles in view.
[[nodiscard]] Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect);

}  // namespace alcove::sample
