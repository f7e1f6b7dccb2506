#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// Returns a camera that looks at the subject of a scene (find_subject()) from above and from one
// side, as near as possible with the whole subject in view. `aspect` is the width of the image
// divided by its height. Of four candidate eyes it takes the first in whose image the subject fills
// a sixth, or the one that shows most of it, where a subject that is cut off counts as if it were
// seen from where all of it is in view. The eye stays inside of a sky and of a closed room.
// Call with_fitted_planes() afterwards.
[[nodiscard]] Camera framing_camera(const Scene& scene, double aspect);

// A range of distances along the view direction, measured from the plane through the eye. In
// orthographic views they may be negative.
struct DepthRange {
  double nearest;
  double farthest;
};

// The depth of the surfaces in a view, at a low resolution.
struct DepthPicture {
  Image<float> depth;               // distance along the view direction; infinite without a surface
  std::optional<DepthRange> range;  // of all triangles within the image; null if nothing is in view
};

// Draws the front faces in view, and the back faces of double-sided materials, without regard to
// near and far plane.
//
// The range is exact if the triangles that could change it are fewer than 2^25. The other blocks of
// triangles count by their bounds, so that the range may then be too wide.
[[nodiscard]] DepthPicture draw_depth(const Scene& scene, const Camera& camera, double aspect);

// Returns the camera with its near and far plane fitted to the triangles in view. If nothing is in
// view, the camera is unchanged.
//
// Perspective: the near plane is at half the distance of the nearest triangle in view, limited to
// 1/5000 to 1/100 of the diagonal of the subject. The far plane is behind the farthest triangle in
// view, and behind the subject for every position and direction of the camera within the subject.
// Orthographic: the planes enclose the triangles in view.
[[nodiscard]] Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect);

// An occlusion radius and where it comes from.
struct RadiusChoice {
  float radius;        // scene units
  std::string reason;  // the end of a sentence that begins with the radius
};

// Returns the radius that suits a view: that of the scene if it suggests one, or a twentieth of the
// extent of the surfaces in view, but at most a quarter of their median distance from the eye.
// These are the surfaces of the subject, or all if the view shows hardly any of the subject.
[[nodiscard]] RadiusChoice radius_for_view(const Scene& scene, const Camera& camera, double aspect);

}  // namespace alcove::sample
