// The cost and the error of each part of the occlusion: one view rendered with one part changed.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/variant.h"
#include "scene/camera.h"

namespace alcove::sample {

// `base` with each part replaced or disabled, one at a time. No variant equals `base`.
[[nodiscard]] std::vector<Variant> ablation_variants(const passes::OcclusionSettings& base);

// Two descriptions of one view, which should give the same image.
struct InvariancePair {
  std::string name;
  Camera first;
  Camera second;
  std::uint32_t scale = 1;  // width and height of the second image over those of the first
  float further = 0.0f;     // distance that the second camera is moved back, scene units
  // The largest difference, in scene units, between the depth of a pixel in the first image and its
  // depth in the second image minus `further`, at which the pixel is compared.
  float tolerance = INFINITY;
};

// `height`: height of the image in pixels.
[[nodiscard]] std::vector<InvariancePair> invariance_pairs(const Camera& camera,
                                                           std::uint32_t height);

}  // namespace alcove::sample
