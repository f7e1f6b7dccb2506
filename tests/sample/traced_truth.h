#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/errors.h"
#include "reference/surface_points.h"
#include "reference/truth.h"
#include "render/frame_renderer.h"

namespace alcove::sample {

// Ray-traced visibility of the surfaces that images of a frame show, and the mask of these
// surfaces.
struct TracedTruth {
  Image<float> visibility;
  Mask surfaces;

  double rmse(const Image<float>& image) const {
    return compare_images(image, visibility, surfaces).rmse;
  }
};

inline TracedTruth trace_truth(const Scene& scene, const Camera& camera, float radius,
                               const FrameImages& images) {
  const Image<float> depth = linear_depth(camera, images.depth_ndc);
  const auto is_surface = [](float z) { return static_cast<std::uint8_t>(std::isfinite(z)); };
  TracedTruth truth{{}, mapped(is_surface, depth)};
  const auto rays = RayScene::create(scene);
  EXPECT_TRUE(rays);
  truth.visibility = occlusion_truth(*rays, surface_points(*rays, camera, images.normal_ws, depth),
                                     {.radius = radius, .spp = 64}, nullptr)
                         .visibility;
  return truth;
}

}  // namespace alcove::sample
