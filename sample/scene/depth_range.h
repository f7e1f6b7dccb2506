#pragma once

#include <optional>

#include "scene/scene.h"

namespace alcove::sample {

// A range of distances along the view direction, measured from the plane through the eye. In
// orthographic views they may be negative.
struct DepthRange {
  double nearest;
  double farthest;
};

// Returns the range of depths of the triangles within the image, or null if nothing is in view.
// `aspect` is the image's width divided by its height. Perspective views leave out triangles behind
// the eye.
//
// The range is exact if the instances whose bounds could change it have fewer than 2^25 triangles
// together. Otherwise bounds are used instead of triangles, so that the range may be too wide.
[[nodiscard]] std::optional<DepthRange> depth_in_view(const Scene& scene, const Camera& camera,
                                                      double aspect);

// Returns the camera with its near and far plane fitted to the triangles in view. If nothing is in
// view, the camera is unchanged.
//
// Perspective: the near plane is at half the distance of the nearest triangle in view, limited to
// 1/5000 to 1/100 of the diagonal of the scene's core. The far plane is behind the farthest
// triangle in view, and behind the core for every position and direction of the camera within the
// core. Orthographic: the planes enclose the triangles in view.
[[nodiscard]] Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect);

}  // namespace alcove::sample
