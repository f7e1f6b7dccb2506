// Ambient occlusion by brute force: every slice is marched in steps of half a pixel over the exact
// surfaces and integrated numerically in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "drawing.h"

namespace alcove::passes {

struct ReferenceOcclusion {
  double visibility = 0.0;
  glm::dvec3 bent_normal{0.0};  // unit, view space
};

// Returns the occlusion of pixel (x, y), which must show a surface. An occluder is everything that
// the image shows within `radius` of the point, and everything behind it within the plane of a
// slice.
ReferenceOcclusion reference_occlusion(const Drawing& drawing, std::uint32_t x, std::uint32_t y,
                                       double radius);

}  // namespace alcove::passes
