#pragma once

#include "reference/truth.h"
#include "scene/environment.h"

namespace alcove::sample {

// The materials that the pass was given, per pixel.
struct SurfaceMaterials {
  Image<glm::vec3> albedo;  // base colour, linear
  Image<float> roughness;   // perceptual
  Image<float> metallic;
};

// Radiance towards the eye, lit by the environment.
struct LitTruth {
  Image<glm::vec3> diffuse;
  Image<glm::vec3> specular;
  // Noise of each: half the difference between the means of two halves of the samples.
  Image<glm::vec3> diffuse_noise;
  Image<glm::vec3> specular_noise;
};

// Computes the lit image by path tracing with unlimited bounces and the environment as the only
// light. A path segment that hits nothing within the radius receives the environment's light, as in
// interreflection_truth(): farther surfaces cast no shadow, because occlusion of this radius does
// not model them.
//
// At every bounce, the material is GGX with Smith's height-correlated masking and Schlick's
// Fresnel, over a Lambertian part that is scaled by 1 - E(view), where E is the directional albedo
// of the GGX part. Bounces after the first use the normals of the triangles. Skipped points are
// zero.
[[nodiscard]] LitTruth lit_truth(const RayScene& scene, const SurfacePoints& points,
                                 const SurfaceMaterials& materials, const Viewer& viewer,
                                 const EnvironmentImage& environment, const TruthSettings& settings,
                                 const Progress& progress = {});

}  // namespace alcove::sample
