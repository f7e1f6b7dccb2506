#pragma once

#include <optional>
#include <vector>

#include "evaluate/truths.h"
#include "reference/lit_truth.h"
#include "reference/truth.h"
#include "render/rendering.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Ray-traced truths of multi-bounce and specular occlusion. They are expensive, so they are traced
// at about 30,000 pixels, one at random in each block of the image. The other pixels are undefined.
struct IndirectTruths {
  std::uint32_t block = 1;  // width and height of a block in pixels
  Mask sampled;             // the traced pixels
  SurfacePoints points;
  Image<glm::vec3> interreflection;
  std::vector<Image<float>> specular;  // for each of roughness_images()
  std::optional<LitTruth> lit;  // for the first roughness, if IndirectRequest::lit_steps is set
};

// The perceptual roughness for each specular occlusion of a rendering.
[[nodiscard]] std::vector<Image<float>> roughness_images(const Rendering& rendering);

// Computes them, or takes them from the cache on disk. Progress on stderr.
[[nodiscard]] Result<IndirectTruths> compute_indirect_truths(const Rendering& rendering,
                                                             const TruthOptions& options);

}  // namespace alcove::sample
