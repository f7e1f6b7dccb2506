// Ambient occlusion by brute force: each slice is marched over the exact surfaces in steps of half
// a pixel, and integrated numerically in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "drawing.h"

namespace alcove::passes {

struct ReferenceOcclusion {
  double visibility = 0.0;
  glm::dvec3 bent_normal{0.0};  // unit, view space
};

// Returns the occlusion of pixel (x, y), which must show a surface. Every surface point that the
// image shows within `radius` is an occluder, and so is everything behind it in the plane of the
// slice (occluders are infinitely thick).
ReferenceOcclusion reference_occlusion(const Drawing& drawing, std::uint32_t x, std::uint32_t y,
                                       double radius);

}  // namespace alcove::passes
