#pragma once

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// Returns the surface points of the rasterised pixels for the ray tracer: the hits of primary rays
// through the pixel centres, or the points of the depth buffer if a ray misses the rasterised
// surface, as happens at an edge through the centre. `normal_ws` are the normals that the occlusion
// pass was given; `depth` is a result of linear_depth().
[[nodiscard]] SurfacePoints surface_points(const RayScene& rays, const Camera& camera,
                                           const Image<glm::vec3>& normal_ws,
                                           const Image<float>& depth);

}  // namespace alcove::sample
