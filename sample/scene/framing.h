#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

namespace alcove::sample {

// What a scene shows, without what only surrounds it.
struct SceneCore {
  Bounds bounds_ws;
  uint64_t triangles_outside = 0;  // that do not count for the bounds
};

// Bounds of what the scene is about. Left out are meshes that are more than ten times larger than
// everything smaller than them and only surround it (sky domes, ground planes), and then triangles
// outside the central 99 % of the triangles by number or by area, where that makes the bounds at
// least four times smaller (slivers far away). Otherwise the bounds of all triangles.
[[nodiscard]] SceneCore scene_core(const std::vector<Mesh>& meshes);

// Looks at the core of a scene from above and from the side, so that all of it is in view. From
// inside of meshes that surround the core, where there is room. Its planes are to be fitted.
[[nodiscard]] Camera framing_camera(const Scene& scene);

// Least and greatest distance along the view axis of the triangles within the image; the eye's
// plane is at 0. `aspect` is width over height. Perspective views count what lies in front of the
// eye. None where nothing is in view.
struct DepthRange {
  double nearest;
  double farthest;
};
[[nodiscard]] std::optional<DepthRange> depth_in_view(const Scene& scene, const Camera& camera,
                                                      double aspect);

// The camera with its near plane at half the distance of the nearest triangle in view, within
// 1/5000 and 1/100 of the core's diagonal, and its far plane behind the farthest one and behind the
// core from wherever in it the camera may turn to. The planes of an orthographic view enclose the
// triangles in view. Unchanged where nothing is in view.
[[nodiscard]] Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect);

}  // namespace alcove::sample
