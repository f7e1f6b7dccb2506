// What each part of the occlusion costs and buys: the same view drawn with one thing changed.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/variant.h"
#include "scene/camera.h"

namespace alcove::sample {

// Every part of `base` exchanged or left out, none of them equal to it.
[[nodiscard]] std::vector<Variant> variants_of(const passes::OcclusionSettings& base);

// Two ways to draw one view, which should look the same.
struct InvariancePair {
  std::string name;
  Camera first;
  Camera second;
  std::uint32_t scale = 1;  // of the second image's sides
  // Lengths, scene units: how much further away the second stands, and by how much more or less
  // the depths of a pixel may differ if it is to show one surface.
  float further = 0.0f;
  float tolerance = INFINITY;
};

// `height` of the image in pixels.
[[nodiscard]] std::vector<InvariancePair> invariance_pairs_of(const Camera& camera,
                                                              std::uint32_t height);

}  // namespace alcove::sample
