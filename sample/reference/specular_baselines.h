#pragma once

#include <vector>

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/image.h"

namespace alcove::sample {

// Baselines of specular occlusion, where 1 is open. Each is the ground truth with one
// approximation.
struct SpecularBaselines {
  // The true visibility, approximated by fifteen polynomials (visibility_polynomials.h).
  Image<float> polynomials;
  // The lobe itself, occluded by the height field of the depth image as in height_field_truth().
  Image<float> depth;
  // Both approximations: the visibility of the height field, approximated by the polynomials.
  Image<float> depth_polynomials;
};

// Baselines for each image of perceptual roughness. `depth_vs` is as in height_field_truth();
// `points` belong to the camera's image. Samples settings.spp directions for the visibility and as
// many for each lobe. Skipped points are open.
[[nodiscard]] std::vector<SpecularBaselines> specular_baselines(
    const RayScene& rays, const SurfacePoints& points, const Image<float>& depth_vs,
    const Camera& camera, const std::vector<Image<float>>& roughness, const TruthSettings& settings,
    const Progress& progress = {});

}  // namespace alcove::sample
