#pragma once

#include <cstdint>

#include "scene/camera.h"
#include "scene/ray_scene.h"
#include "support/glm.h"
#include "support/image.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

inline constexpr uint32_t kNoMaterial = UINT32_MAX;

// The surfaces that primary rays through the pixel centres hit. They serve as a check of the
// rasteriser and as the points at which truths are computed. Normals are unit, face the viewer and
// are zero in the sky.
struct GBuffer {
  Image<float> depth_vs;                 // positive distance along the view axis; infinity: sky
  Image<glm::vec3> position_ws;          // zero in the sky
  Image<glm::vec3> geometric_normal_ws;  // of the triangle
  Image<glm::vec3> shading_normal_ws;    // interpolated from the vertices
  Image<glm::vec3> albedo;               // linear base colour
  Image<float> roughness;                // perceptual
  Image<float> metallic;
  Image<uint32_t> material;  // kNoMaterial: sky
};

// The points at which a truth is computed, one per pixel. A zero normal marks a pixel to skip, such
// as the sky, which gets the value of an open surface.
struct SurfacePoints {
  // Positions must be precise to a few rounding errors, like those of cast_gbuffer(). Positions
  // from a depth buffer that is not reversed may have larger errors than the offset of the ray
  // origins; surfaces then occlude themselves.
  Image<glm::vec3> position_ws;
  Image<glm::vec3> normal_ws;            // the normal that the occlusion pass was given; unit
  Image<glm::vec3> geometric_normal_ws;  // faces the viewer; ray origins are offset along it
};

struct TruthSettings {
  float radius = 0.5f;  // scene units, > 0, may be infinite; farther hits do not occlude
  uint32_t spp = 512;   // rays per pixel (and per roughness), >= 1
  uint32_t seed = 1;
};

// Cosine-weighted visibility (equation 2 of [Jimenez 2016]) by ray tracing: the fraction of
// settings.spp rays that hit nothing within the radius, and the bent normal.
struct OcclusionTruth {
  Image<float> visibility;  // 0..1, 1 is open
  // The unit direction of the cosine-weighted mean of the visible directions; the normal if nothing
  // is visible, and zero in the sky.
  Image<glm::vec3> bent_normal_ws;
};

[[nodiscard]] GBuffer cast_gbuffer(const RayScene& scene, const Camera& camera, uint32_t width,
                                   uint32_t height);

[[nodiscard]] OcclusionTruth occlusion_truth(const RayScene& scene, const SurfacePoints& points,
                                             const TruthSettings& settings,
                                             const Progress& progress = {});

// The view directions of a camera. In an orthographic view, the unit direction from any surface
// point towards the eye is `view_ws`. In perspective it is the direction to `eye_ws`.
struct Viewer {
  bool orthographic = false;
  glm::vec3 eye_ws{0.0f};
  glm::vec3 view_ws{0.0f, 0.0f, 1.0f};
};
[[nodiscard]] Viewer make_viewer(const Camera& camera);
// The unit direction from a point towards the eye.
[[nodiscard]] glm::vec3 view_from(const Viewer& viewer, const glm::vec3& position_ws);
// Computes specular occlusion S = integral V f <n,w> / integral f <n,w> over the hemisphere of n,
// where V is visibility within the radius and f is the GGX BRDF (Smith's height-correlated masking,
// without Fresnel). Visible normals are sampled. `roughness` is perceptual, one value per pixel.
[[nodiscard]] Image<float> specular_truth(const RayScene& scene, const SurfacePoints& points,
                                          const Image<float>& roughness, const Viewer& viewer,
                                          const TruthSettings& settings,
                                          const Progress& progress = {});

// Computes interreflection: the irradiance divided by pi that arrives at a point in a white
// environment of radiance 1, with Lambertian surfaces and unlimited bounces. A path segment that
// hits nothing within the occlusion radius receives the environment's light. The result is between
// 0 and 1 for albedos up to 1. It is not multiplied by the point's own albedo, so it equals the
// visibility if all surfaces are black.
[[nodiscard]] Image<glm::vec3> interreflection_truth(const RayScene& scene,
                                                     const SurfacePoints& points,
                                                     const TruthSettings& settings,
                                                     const Progress& progress = {});

}  // namespace alcove::sample
