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
[[nodiscard]] std::vector<Variant> variants_of(const passes::OcclusionSettings& base);

// Two descriptions of one view, which should give the same image.
struct InvariancePair {
  std::string name;
  Camera first;
  Camera second;
  std::uint32_t scale = 1;  // width and height of the second image over those of the first
  float further = 0.0f;     // distance that the second camera is moved back, scene units
  // A pixel is compared if its depth in the second image, less `further`, differs by at most this
  // from its depth in the first image; scene units.
  float tolerance = INFINITY;
};

// `height`: height of the image in pixels.
[[nodiscard]] std::vector<InvariancePair> invariance_pairs_of(const Camera& camera,
                                                              std::uint32_t height);

}  // namespace alcove::sample
