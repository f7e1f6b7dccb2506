#pragma once

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

struct HeightFieldSettings {
  float radius = 0.5f;   // scene units, > 0
  uint32_t slices = 64;  // per pixel, evenly spaced in angle around the view vector, >= 1
};

// The visibility that the depth image alone allows: the limit of a method that sees one depth layer
// and takes whatever lies behind it as solid. By brute force, and sharing no code with the shaders.
struct HeightFieldTruth {
  Image<float> visibility;          // 0..1; 1 in the sky
  Image<glm::vec3> bent_normal_ws;  // unit; zero in the sky
};
// `depth_vs`: positive distance along the view axis, infinity (or not finite) in the sky, which
// blocks nothing. `normal_ws`: unit, zero in the sky. Both of the camera's image, pixel centres.
[[nodiscard]] HeightFieldTruth height_field_truth(const Image<float>& depth_vs,
                                                  const Image<glm::vec3>& normal_ws,
                                                  const Camera& camera,
                                                  const HeightFieldSettings& settings,
                                                  const Progress& progress = {});

}  // namespace alcove::sample
