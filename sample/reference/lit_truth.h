#pragma once

#include "reference/truth.h"
#include "scene/environment.h"

namespace alcove::sample {

// The materials that the pass was given, a pixel each.
struct SurfaceMaterials {
  Image<glm::vec3> albedo;  // base colour, linear
  Image<float> roughness;   // perceptual
  Image<float> metallic;
};

// Light that the environment sends to the eye.
struct LitTruth {
  Image<glm::vec3> diffuse;
  Image<glm::vec3> specular;
  // What their noise is: half of the difference of two halves of the samples.
  Image<glm::vec3> diffuse_noise;
  Image<glm::vec3> specular_noise;
};

// Path traced, infinite bounces, light of the environment alone. A path's segment that meets
// nothing within the radius sees the environment, as in interreflection_truth: it is the light that
// occlusion of this radius models, and what lies farther casts no shadow.
//
// Materials, at every bounce: GGX with Smith's correlated masking and Schlick's Fresnel over a
// Lambertian part that gets what the first leaves, 1 - E(view), with E what it reflects of white
// light; at bounces about the triangles' own normals. Zero where points are skipped.
[[nodiscard]] LitTruth lit_truth(const RayScene& scene, const SurfacePoints& points,
                                 const SurfaceMaterials& materials, const Viewer& viewer,
                                 const EnvironmentImage& environment, const TruthSettings& settings,
                                 const Progress& progress = {});

}  // namespace alcove::sample
