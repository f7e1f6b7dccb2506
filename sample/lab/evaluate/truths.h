#pragma once

#include <string>

#include "reference/height_field_truth.h"
#include "reference/truth.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Precision and extent of the truths.
struct TruthOptions {
  std::uint32_t spp = 256;  // rays per pixel
  // Approximate number of pixels at which multi-bounce, specular occlusion and the lit image are
  // traced.
  std::uint32_t indirect_points = 32'000;
  bool use_cache = true;  // whether the cache on disk is read and written
};

// A frame whose truths are computed. Borrows everything.
struct TruthFrame {
  const Scene& scene;
  const Camera& camera;
  float radius;  // radius of the occlusion, scene units
  const Image<float>& depth_ndc;
  const Image<glm::vec3>& normal_ws;  // the normals that the occlusion pass was given
};

// Both truths of a frame, and the pixels at which they are defined.
struct Truths {
  OcclusionTruth scene;           // ray traced
  HeightFieldTruth height_field;  // brute force on the same depth buffer
  Mask surfaces;                  // pixels that are not sky
};

// Computes the truths, or reads them from the cache on disk. They are computed at the points where
// primary rays through the pixel centres hit the scene, with the normals that the occlusion pass
// was given. Prints progress on stderr. Error: the view shows nothing but sky.
[[nodiscard]] Result<Truths> compute_truths(const TruthFrame& frame, const TruthOptions& options);

}  // namespace alcove::sample
