#pragma once

#include <vector>

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/image.h"

namespace alcove::sample {

// Baselines of specular occlusion, between 0 and 1 (open). Each is the ground truth, except for the
// approximations that the comment of its image names.
struct SpecularBaselines {
  // The true visibility, approximated by fifteen polynomials (visibility_polynomials.h).
  Image<float> polynomials;
  // The lobe itself, occluded by the height field of the depth image as in height_field_truth().
  Image<float> depth;
  // Both approximations: the visibility of the height field, approximated by the polynomials.
  Image<float> depth_polynomials;
};

// Computes the baselines for each image of perceptual roughness in `roughness`. `depth_vs` is as in
// height_field_truth(), and `points` are the surface points of the same image. settings.spp
// directions are traced for the visibility, and as many for each lobe. The result is 1 at skipped
// points.
[[nodiscard]] std::vector<SpecularBaselines> specular_baselines(
    const RayScene& rays, const SurfacePoints& points, const Image<float>& depth_vs,
    const Camera& camera, const std::vector<Image<float>>& roughness, const TruthSettings& settings,
    const Progress& progress = {});

}  // namespace alcove::sample
