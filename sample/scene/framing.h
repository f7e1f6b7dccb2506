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
// The subject of a scene is everything but skies, grounds and strays, judged by the boxes of the
// instances of meshes. A sky, or the shell of a room, contains the rest, is at least three times as
// large in both horizontal directions, and shows its front inside. A ground is flat, below the
// rest, and as much wider. Strays are triangles outside the box that holds 99.9 % of the area, if
// the subject is clearly larger with them. Scenes of more than 2^23 triangles are judged by their
// box alone.
class ViewFinder {
 public:
  explicit ViewFinder(const Scene& scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  // A sentence on what the subject lacks, or empty.
  [[nodiscard]] const std::string& left_out() const { return left_out_; }
  // Returns a camera that looks at the whole subject diagonally from above, inside of a sky, from
  // the first of four sides or one that shows clearly more front faces. If these views mostly show
  // the backs of faces, as those of a room, the eye is inside. with_fitted_planes() sets its near
  // and far plane.
  [[nodiscard]] Camera framing_camera(double aspect) const;
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
