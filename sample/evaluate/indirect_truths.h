#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/truths.h"
#include "reference/lit_truth.h"
#include "reference/specular_baselines.h"
#include "reference/truth.h"
#include "render/rendering.h"
#include "support/image.h"

namespace alcove::sample {

// What multi-bounce and specular occlusion should have been, ray traced. A path costs many times
// what a ray of visibility does, so these are taken at some 30,000 pixels, one at random in each
// block of the picture; elsewhere they mean nothing.
struct IndirectTruths {
  std::uint32_t block = 1;  // pixels on a side of a block
  Mask sampled;             // not sky
  SurfacePoints points;
  Image<glm::vec3> interreflection;
  std::vector<Image<float>> specular;                 // for each of roughness_images()
  std::vector<SpecularBaselines> specular_baselines;  // likewise
  std::optional<LitTruth> lit;  // where RenderRequest::light asks for it, for the first
};

// The perceptual roughness that each specular occlusion of a rendering was made for.
[[nodiscard]] std::vector<Image<float>> roughness_images(const Rendering& rendering);

// Computes them, or takes them from the cache on disk. Progress on stderr.
[[nodiscard]] tl::expected<IndirectTruths, std::string> indirect_truths_of(
    const Rendering& rendering, const TruthOptions& options);

}  // namespace alcove::sample
