#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/camera.h"
#include "scene/scene.h"
#include "support/glm.h"
#include "support/image.h"
#include "support/progress.h"

namespace alcove::sample {

inline constexpr uint32_t kNoMaterial = UINT32_MAX;

// What primary rays through the pixel centres see; the check of the rasteriser and the points at
// which the truths are taken. Normals are unit, face the viewer and are zero in the sky.
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

// Where a truth is wanted: one entry per pixel. A zero normal marks a pixel to skip (sky), which
// gets the value of an open surface.
struct SurfacePoints {
  // Exact to a few roundings, as cast_gbuffer's are; positions from a depth buffer of the usual
  // direction can be off by more than rays start off the surface, and then meet it.
  Image<glm::vec3> position_ws;
  Image<glm::vec3> normal_ws;            // the normal that the occlusion pass was given; unit
  Image<glm::vec3> geometric_normal_ws;  // faces the viewer; rays start off the surface along it
};

struct TruthSettings {
  float radius = 0.5f;  // scene units, > 0; a hit beyond it does not block. Infinity is allowed
  uint32_t spp = 512;   // rays per pixel (and per roughness), >= 1
  uint32_t seed = 1;
};

// Cosine-weighted visibility, paper eq. 2: the share of spp rays that meet nothing within the
// radius.
struct OcclusionTruth {
  Image<float> visibility;  // 0..1, 1 is open
  // Unit, along the cosine-weighted mean of visible directions; the normal where nothing is
  // visible, zero in the sky.
  Image<glm::vec3> bent_normal_ws;
};

// The triangles of a scene in Embree's tree. Alpha-masked texels do not block. Immutable once made;
// any thread may trace. Borrows the scene, which must outlive it.
class RayScene {
 public:
  // Errors: Embree has no device or no memory; the scene reaches further than 1e12 from its origin.
  [[nodiscard]] static tl::expected<RayScene, std::string> create(const Scene& scene);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  RayScene();
  std::unique_ptr<Impl> impl_;
};

[[nodiscard]] GBuffer cast_gbuffer(const RayScene& scene, const Camera& camera, uint32_t width,
                                   uint32_t height);

[[nodiscard]] OcclusionTruth occlusion_truth(const RayScene& scene, const SurfacePoints& points,
                                             const TruthSettings& settings,
                                             const Progress& progress = {});

// S = integral V f <n,w> / integral f <n,w> over the hemisphere of n, f the GGX lobe (Smith
// height-correlated masking, Fresnel left out), by sampling visible normals. `roughness` is
// perceptual, per pixel; `eye_ws` unused where orthographic, then `view_ws` (unit, towards the eye)
// holds everywhere.
struct Viewer {
  bool orthographic = false;
  glm::vec3 eye_ws{0.0f};
  glm::vec3 view_ws{0.0f, 0.0f, 1.0f};
};
[[nodiscard]] Viewer viewer_of(const Camera& camera);
// From a point towards the eye, unit.
[[nodiscard]] glm::vec3 view_from(const Viewer& viewer, const glm::vec3& position_ws);
[[nodiscard]] Image<float> specular_truth(const RayScene& scene, const SurfacePoints& points,
                                          const Image<float>& roughness, const Viewer& viewer,
                                          const TruthSettings& settings,
                                          const Progress& progress = {});

// Interreflection: the irradiance over pi that reaches a point in a white environment of radiance
// 1, surfaces Lambertian with their own albedo, infinite bounces. The radius is that of the
// occlusion: a path segment that meets nothing within it sees the environment. 0..1 for albedos up
// to 1; not multiplied by the point's own albedo, so with black surfaces it equals the visibility.
[[nodiscard]] Image<glm::vec3> interreflection_truth(const RayScene& scene,
                                                     const SurfacePoints& points,
                                                     const TruthSettings& settings,
                                                     const Progress& progress = {});

}  // namespace alcove::sample
