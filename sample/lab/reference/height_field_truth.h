#pragma once

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

struct HeightFieldSettings {
  float radius = 0.5f;   // scene units, > 0
  uint32_t slices = 64;  // per pixel, evenly spaced in angle around the view direction, >= 1
};

// The visibility of the depth image taken as a solid height field: the limit of a method that uses
// one depth layer and infinite thickness. It is computed by brute force and shares no code with the
// shaders.
struct HeightFieldTruth {
  Image<float> visibility;          // 0..1; 1 in the sky
  Image<glm::vec3> bent_normal_ws;  // unit; zero in the sky
};
// Computes the truth of a depth image. `depth_vs` is the positive distance along the view axis; it
// is infinite or NaN in the sky, which occludes nothing. `normal_ws` is unit, and zero in the sky.
// Both are sampled at the pixel centres of the camera's image.
[[nodiscard]] HeightFieldTruth height_field_truth(const Image<float>& depth_vs,
                                                  const Image<glm::vec3>& normal_ws,
                                                  const Camera& camera,
                                                  const HeightFieldSettings& settings,
                                                  const Progress& progress = {});

}  // namespace alcove::sample
