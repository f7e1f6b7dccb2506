#pragma once

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// The rasteriser's pixels as points for the ray tracer: where primary rays through the pixel
// centres meet the scene, and the depth buffer's where they miss what was rasterised (an edge
// through the centre). `normal_ws` is what the occlusion was given, `depth` as linear_depth() has
// it.
[[nodiscard]] SurfacePoints surface_points(const RayScene& rays, const Camera& camera,
                                           const Image<glm::vec3>& normal_ws,
                                           const Image<float>& depth);

}  // namespace alcove::sample
