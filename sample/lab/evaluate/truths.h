#pragma once

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

// The ray-traced truth of a frame, and the pixels at which it is defined.
struct Truths {
  OcclusionTruth scene;
  Mask surfaces;  // pixels that are not sky
};

// Traces the truth of a frame, or reads it from the cache on disk. It is traced at the points where
// primary rays through the pixel centres hit the scene, with the normals that the occlusion pass
// was given. Prints progress on stderr. Error: the view shows nothing but sky.
[[nodiscard]] Result<Truths> compute_truths(const TruthFrame& frame, const TruthOptions& options);

// Computes the height-field truth of a frame by brute force on the same depth buffer, or reads it
// from the cache.
[[nodiscard]] HeightFieldTruth compute_height_field_truth(const TruthFrame& frame,
                                                          const TruthOptions& options);

}  // namespace alcove::sample
