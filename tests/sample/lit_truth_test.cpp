#include "reference/lit_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analytic_points.h"
#include "scene/analytic_scenes.h"

namespace alcove::sample {
namespace {

SurfaceMaterials materials_of(const SurfacePoints& points, const glm::vec3& albedo, float roughness,
                              float metallic) {
  const uint32_t width = points.normal_ws.width;
  return {{width, 1, albedo}, {width, 1, roughness}, {width, 1, metallic}};
}

// A view direction at about 50 degrees from every normal.
Viewer make_viewer(const SurfacePoints& points) {
  const glm::vec3& n = points.normal_ws.at(0, 0);
  const glm::vec3 across = glm::normalize(glm::cross(n, glm::vec3(0.3f, 0.5f, -0.8f)));
  return {true, {}, glm::normalize(n + 1.2f * across)};
}

EnvironmentImage white() { return {16, 8, glm::vec3(1.0f)}; }

LitTruth light(const char* name, const glm::vec3& albedo, float roughness, float metallic) {
  auto analytic = analytic_scene(name).value();
  for (Material& material : analytic.scene.materials) {
    material.base_color = glm::vec4(albedo, 1.0f);
    material.roughness = roughness;
    material.metallic = metallic;
  }
  const auto rays = RayScene::create(analytic.scene);
  const SurfacePoints points = points_of(analytic);
  return lit_truth(*rays, points, materials_of(points, albedo, roughness, metallic),
                   make_viewer(points), white(),
                   {static_cast<float>(analytic.closed_form_radius), 2048, 1});
}

TEST(LitTruth, WhiteDielectricOfAnyShapeReflectsAllLightOfAWhiteEnvironment) {
  for (const char* name : {"plane:30", "groove:90", "pit"}) {
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
      const LitTruth lit = light(name, glm::vec3(1.0f), roughness, 0.0f);
      for (size_t i = 0; i < lit.diffuse.pixels.size(); ++i) {
        const float out = lit.diffuse.pixels[i].x + lit.specular.pixels[i].x;
        // The diffuse part receives the energy that single scattering of microfacets loses.
        EXPECT_NEAR(out, 1.0f, 0.03f) << name << " roughness " << roughness;
      }
    }
  }
}

TEST(LitTruth, BlackMetalReflectsOnlyFresnelLight) {
  const LitTruth lit = light("groove:90", glm::vec3(0.0f), 0.5f, 1.0f);
  for (size_t i = 0; i < lit.diffuse.pixels.size(); ++i) {
    EXPECT_EQ(lit.diffuse.pixels[i].x, 0.0f);
    EXPECT_LT(lit.specular.pixels[i].x, 0.1f) << "Fresnel reflection at grazing angles";
  }
}

TEST(LitTruth, ReportedNoiseOfDiffuseAndSpecularLightIsBelowTwoPercent) {
  const LitTruth a = light("groove:90", glm::vec3(0.5f), 0.5f, 0.0f);
  for (size_t i = 0; i < a.diffuse.pixels.size(); ++i) {
    EXPECT_LT(std::abs(a.diffuse_noise.pixels[i].x), 0.02f);
    EXPECT_LT(std::abs(a.specular_noise.pixels[i].x), 0.02f);
  }
}

TEST(LitTruth, PointWithoutANormalIsBlack) {
  const auto analytic = analytic_scene("plane:30").value();
  const auto rays = RayScene::create(analytic.scene);
  SurfacePoints points = points_of(analytic);
  const Viewer viewer = make_viewer(points);
  points.normal_ws.at(0, 0) = glm::vec3(0.0f);
  const LitTruth lit = lit_truth(*rays, points, materials_of(points, glm::vec3(1.0f), 0.5f, 0.0f),
                                 viewer, white(), {1.0f, 16, 1});
  EXPECT_EQ(lit.diffuse.at(0, 0), glm::vec3(0.0f));
}

}  // namespace
}  // namespace alcove::sample
