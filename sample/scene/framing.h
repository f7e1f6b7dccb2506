#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/ray_scene.h"
#include "scene/scene.h"

namespace alcove::sample {

// An occlusion radius.
struct RadiusChoice {
  float radius;        // scene units
  std::string reason;  // where it comes from: the end of a sentence that begins with the radius
  std::string advice;  // a sentence on what to do if the view shows few surfaces, else empty
};

// Chooses cameras and radii by rays through a scene, which must outlive it.
//
// The subject of a scene is everything but skies, grounds and strays. From the outside in, the
// shortest run of the widest parts (instances of meshes) that surrounds the rest, at least three
// times as wide in both horizontal directions, is a ground, if its parts are flat and below the
// rest, a sky or the shell of a room, or both. A sky is far away on nearly all sides and above; it
// may be open above if its outside is not drawn. Strays are triangles that reach further than 30
// times the median from the median, or lie outside the box that holds 99.9 % of the area if the
// subject is clearly larger with them. Scenes of more than 2^23 triangles are judged by their box
// alone.
class ViewFinder {
 public:
  // The name of framing_camera(). Cameras of files have a name that is not empty.
  static constexpr const char* kFrame = "";

  explicit ViewFinder(const Scene& scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  // A sentence on what the subject lacks, or empty.
  [[nodiscard]] const std::string& left_out() const { return left_out_; }
  // Returns a camera that looks at the whole subject diagonally from above, inside of a sky, from
  // the first of four sides or one that shows clearly more meshes or fewer back faces that are not
  // drawn. The eye is inside a subject that shows clearly more so and then surrounds it, and below
  // one of which nothing is seen otherwise. with_fitted_planes() sets its near and far plane.
  [[nodiscard]] Camera framing_camera(double aspect) const;
  // Whether the view shows more than sky in at least one of 200 pixels.
  [[nodiscard]] bool shows_subject(const Camera& camera, double aspect) const;
  // Returns the camera with a near and far plane around the surfaces in view.
  [[nodiscard]] Camera with_fitted_planes(const Camera& camera, double aspect) const;
  // Returns the radius of the scene if it suggests one, or a twentieth of the width of the view at
  // the median distance of the surfaces in view.
  [[nodiscard]] RadiusChoice radius(const Camera& camera, double aspect) const;

 private:
  struct Picture;
  [[nodiscard]] Picture look(const Camera& camera, double aspect) const;

  const Scene& scene_;
  std::optional<RayScene> rays_;
  Bounds subject_ws_;
  std::vector<uint32_t> skies_;  // indices of meshes
  std::string left_out_;
};

}  // namespace alcove::sample
