#pragma once

#include <vector>

#include "reference/truth.h"
#include "scene/camera.h"
#include "support/image.h"

namespace alcove::sample {

// Specular occlusion, 1 open, of which only one step on the way to it is not the truth.
struct SpecularBaselines {
  // The true visibility, kept as fifteen numbers that any lobe can be asked of.
  Image<float> polynomials;
  // The lobe itself, within what the depth image leaves open as height_field_truth() takes it.
  Image<float> depth;
  // Both: what the depth image leaves open, kept as the numbers.
  Image<float> depth_polynomials;
};

// One for each of `roughness`, perceptual, per pixel. `depth_vs` as height_field_truth() takes it;
// `points` are of the camera's image. Takes settings.spp directions for visibility and as many for
// each lobe; skipped points are open.
[[nodiscard]] std::vector<SpecularBaselines> specular_baselines(
    const RayScene& rays, const SurfacePoints& points, const Image<float>& depth_vs,
    const Camera& camera, const std::vector<Image<float>>& roughness, const TruthSettings& settings,
    const Progress& progress = {});

}  // namespace alcove::sample
