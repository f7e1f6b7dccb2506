// Compares specular occlusion from slices with the GGX lobe traced over the exact surfaces, and
// checks unoccluded scenes.
#include <gmock/gmock.h>

#include <cmath>

#include "gtao_scenes.h"
#include "maths/ggx.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using SpecularOcclusionFromSlices = PassTest;
using glm::dvec3;

OcclusionSettings settings_of(AlcoveQuality quality, float radius, float roughness) {
  OcclusionSettings settings(quality, radius);
  settings.specular = ALCOVE_SPECULAR_SLICES;
  settings.roughness = roughness;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  return settings;
}

// Returns the fraction of the lobe at a pixel that meets no surface within the radius. Rays are
// cast in the directions that evenly distributed visible microfacets reflect.
double cast_lobe(const Drawing& drawing, std::uint32_t x, std::uint32_t y, double radius,
                 float roughness) {
  constexpr int kSide = 48;
  const float alpha = roughness * roughness;
  const auto hit = cast(drawing.scene, drawing.camera.ray(x + 0.5, y + 0.5));
  const dvec3 normal = hit->normal, view = drawing.camera.to_eye(x, y);
  const dvec3 across = glm::normalize(glm::cross(normal, dvec3(0.31, 0.74, 0.2)));
  const glm::dmat3 world(across, glm::cross(normal, across), normal);
  const glm::vec3 local_view(glm::transpose(world) * view);
  double visible = 0.0, open = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int row = i / kSide;
    const glm::vec3 half = maths::sample_ggx_normal(
        local_view, alpha, (float(i % kSide) + 0.5f) / kSide, (float(row) + 0.5f) / kSide);
    const glm::vec3 light = glm::reflect(-local_view, half);
    if (light.z <= 0.0f) continue;
    const double share = maths::ggx_shadowing(local_view.z, light.z, alpha);
    const Ray ray{hit->position + 1e-6 * normal, world * dvec3(light)};
    const auto met = cast(drawing.scene, ray);
    open += share;
    if (!met || glm::length(met->position - hit->position) > radius) visible += share;
  }
  return open > 0.0 ? visible / open : 1.0;
}

// Returns the mean error over every 7th pixel of every 5th row.
double mean_error(const HostImage& specular, const Drawing& drawing, double radius,
                  float roughness) {
  double sum = 0.0;
  int count = 0;
  for (std::uint32_t y = 1; y < specular.height; y += 5) {
    for (std::uint32_t x = 2; x < specular.width; x += 7) {
      if (!drawing.is_sky(x, y)) {
        sum += std::abs(specular.at(x, y) - cast_lobe(drawing, x, y, radius, roughness));
        ++count;
      }
    }
  }
  return sum / count;
}

TEST_F(SpecularOcclusionFromSlices, SpecularOcclusionAgreesWithRaysCastThroughTheLobe) {
  const float radius = 1.2f;
  // Tests a perspective and an orthographic view of scenes whose occluders extend as far back as
  // the estimator assumes.
  for (const TestView& view : {test_views().front(), test_views().back()}) {
    for (const NamedScene& scene : {gtao_scenes()[0], gtao_scenes()[1]}) {
      const Drawing drawing = draw(view, 60, 40, scene.scene);
      for (const AlcoveEstimator estimator :
           {ALCOVE_ESTIMATOR_HORIZONS, ALCOVE_ESTIMATOR_CONNECTED}) {
        for (const float roughness : {0.15f, 0.3f, 0.6f, 1.0f}) {
          SCOPED_TRACE(testing::Message()
                       << scene.name << ", " << view.name << ", roughness " << roughness
                       << (estimator == ALCOVE_ESTIMATOR_CONNECTED ? ", connected" : ", horizons"));
          OcclusionSettings settings = settings_of(ALCOVE_QUALITY_HEIGHT_FIELD, radius, roughness);
          settings.estimator = estimator;
          settings.hidden_occlusion = 1.0f;
          const auto images = render(drawing, settings);
          EXPECT_LT(mean_error(images.specular, drawing, radius, roughness), 0.02);
        }
      }
    }
  }
}

// The error decreases over several frames. In a single frame few slices cross a narrow lobe.
TEST_F(SpecularOcclusionFromSlices, ErrorOfNarrowSpecularLobesDecreasesOverAccumulatedFrames) {
  const float radius = 1.2f, roughness = 0.2f;
  const TestView view = test_views().front();
  const Drawing drawing = draw(view, 60, 40, groove(0.8));
  double first = 0.0, last = 0.0;
  for (std::uint32_t index = 0; index < 32; ++index) {
    const auto images =
        render(drawing, settings_of(ALCOVE_QUALITY_MEDIUM, radius, roughness), index);
    last = mean_error(images.specular, drawing, radius, roughness);
    first = index == 0 ? last : first;
  }
  EXPECT_LT(last, 0.05);
  EXPECT_LT(last, 0.8 * first);
}

}  // namespace
}  // namespace alcove::passes
