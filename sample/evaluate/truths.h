#pragma once

#include <string>
#include <tl/expected.hpp>

#include "reference/height_field_truth.h"
#include "reference/truth.h"
#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// How exactly truths are computed.
struct TruthOptions {
  std::uint32_t spp = 256;  // rays per pixel
  // Pixels at which multi-bounce, specular occlusion and the lit picture are traced, about.
  std::uint32_t indirect_points = 32'000;
  bool use_cache = true;  // Reads and writes the cache on disk.
};

// A frame that truths are wanted of: borrowed.
struct TruthFrame {
  const Scene& scene;
  const Camera& camera;
  float radius;  // of occlusion, scene units
  const Image<float>& depth_ndc;
  const Image<glm::vec3>& normal_ws;  // that the occlusion was given
};

// Both truths of a frame, and where they can be compared.
struct Truths {
  OcclusionTruth scene;           // ray traced
  HeightFieldTruth height_field;  // by brute force on the same depth buffer
  Mask surfaces;                  // pixels that are not sky
};

// Computes them, or takes them from the cache on disk; a view of sky alone has none. Points are
// where primary rays through the pixel centres meet the scene, normals those that the occlusion was
// given. Progress on stderr.
[[nodiscard]] tl::expected<Truths, std::string> truths_of(const TruthFrame& frame,
                                                          const TruthOptions& options);

}  // namespace alcove::sample
