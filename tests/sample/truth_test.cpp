#include "reference/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analytic_points.h"
#include "evaluate/errors.h"
#include "reference/height_field_truth.h"
#include "scene/analytic_scenes.h"
#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

class ClosedForm : public testing::TestWithParam<const char*> {};

TEST_P(ClosedForm, RayTracedVisibilityAgreesWithTheClosedFormWithinThreeStandardErrors) {
  const auto analytic = analytic_scene(GetParam());
  ASSERT_TRUE(analytic);
  const auto rays = RayScene::create(analytic->scene);
  ASSERT_TRUE(rays);
  constexpr uint32_t kRays = 65536;
  const auto truth = occlusion_truth(*rays, points_of(*analytic),
                                     {static_cast<float>(analytic->closed_form_radius), kRays, 1});
  for (uint32_t i = 0; i < analytic->points.size(); ++i) {
    const double expected = analytic->points[i].visibility;
    // This is the standard error of independent rays. The R2 sequence of the ray tracer has less.
    const double standard_error = std::sqrt(expected * (1.0 - expected) / kRays);
    EXPECT_NEAR(truth.visibility.at(i, 0), expected, 3.0 * standard_error + 1e-6)
        << GetParam() << " point " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForm,
                         testing::Values("plane:0", "plane:85", "groove:30", "groove:90",
                                         "groove:150", "corner", "sphere", "pit", "step"));

// The inputs of the truths for one view of a scene.
struct View {
  GBuffer g;
  SurfacePoints points;
  Mask mask;
};
View view_of(const RayScene& rays, const Camera& camera, uint32_t width, uint32_t height) {
  View view{cast_gbuffer(rays, camera, width, height), {}, {width, height}};
  view.points = {view.g.position_ws, view.g.geometric_normal_ws, view.g.geometric_normal_ws};
  for (size_t i = 0; i < view.mask.pixels.size(); ++i)
    view.mask.pixels[i] = view.g.material.pixels[i] != kNoMaterial;
  return view;
}

TEST(RayTracedTruth, UnoccludedPlaneHasVisibilityExactlyOneAtAnyTilt) {
  for (const char* name : {"plane:0", "plane:45", "plane:80", "plane:88"}) {
    const auto analytic = analytic_scene(name);
    const auto rays = RayScene::create(analytic->scene);
    const View view = view_of(*rays, analytic->scene.cameras[0], 64, 36);
    const auto truth = occlusion_truth(*rays, view.points, {1.0f, 64, 1});
    for (const float v : truth.visibility.pixels) ASSERT_EQ(v, 1.0f) << name;
  }
}

// A scene and its view, scaled.
Scene scaled(Scene scene, float scale) {
  for (Mesh& mesh : scene.meshes)
    for (glm::vec3& position : mesh.positions) position *= scale;
  for (Camera& camera : scene.cameras) {
    camera.eye_ws *= scale;
    camera.target_ws *= scale;
    camera.near_plane *= scale;
    camera.far_plane *= scale;
  }
  scene.bounds_ws = {scene.bounds_ws.low * scale, scene.bounds_ws.high * scale};
  return scene;
}

TEST(RayTracedTruth, VisibilityDoesNotDependOnTheScaleOfTheScene) {
  const Scene scene = analytic_scene("corner")->scene;
  const auto visibility = [&](float scale) {
    const Scene other = scaled(scene, scale);
    const auto rays = RayScene::create(other);
    const View view = view_of(*rays, other.cameras[0], 32, 18);
    const TruthSettings settings{scale, 16, 1};
    for (const glm::vec3& light : interreflection_truth(*rays, view.points, settings).pixels)
      EXPECT_TRUE(light.x >= 0.0f && light.x <= 1.0f) << light.x;
    return occlusion_truth(*rays, view.points, settings).visibility.pixels;
  };
  // Powers of two do not round.
  const auto expected = visibility(1.0f);
  EXPECT_NE(expected, Image<float>(32, 18, 1.0f).pixels);
  for (const float scale : {0x1p-45f, 0x1p-30f, 0x1p30f, 0x1p34f})
    EXPECT_EQ(visibility(scale), expected) << scale;
  const auto too_large = RayScene::create(scaled(scene, 0x1p41f));
  ASSERT_FALSE(too_large);
  EXPECT_THAT(too_large.error(), testing::HasSubstr("further than 1e12"));
}

TEST(RayTracedTruth, MeshWithoutTrianglesIsIgnored) {
  Scene scene = analytic_scene("corner")->scene;
  scene.meshes.emplace_back();
  const auto rays = RayScene::create(scene);
  EXPECT_TRUE(rays) << rays.error();
}

TEST(RayTracedTruth, RaysThatStartBeyondTheTraceableRangeHitNothing) {
  const Scene scene = analytic_scene("corner")->scene;
  const auto rays = RayScene::create(scene);
  for (const float near_plane : {1e19f, 3e38f}) {
    Camera camera = scene.cameras[0];
    camera.near_plane = near_plane;
    camera.far_plane = INFINITY;
    const GBuffer g = cast_gbuffer(*rays, camera, 16, 9);
    for (const uint32_t material : g.material.pixels) EXPECT_EQ(material, kNoMaterial);
  }
}

TEST(RayTracedTruth, BentNormalOfAnUnoccludedPlaneIsItsNormal) {
  const auto analytic = analytic_scene("plane:60");
  const auto rays = RayScene::create(analytic->scene);
  const auto points = points_of(*analytic);
  const auto truth = occlusion_truth(*rays, points, {1.0f, 65536, 1});
  EXPECT_GT(glm::dot(truth.bent_normal_ws.at(0, 0), points.normal_ws.at(0, 0)), 0.99999f);
}

TEST(RayTracedTruth, RayHitsBeyondTheRadiusDoNotOcclude) {
  const auto analytic = analytic_scene("groove:90");
  const auto rays = RayScene::create(analytic->scene);
  const auto truth = occlusion_truth(*rays, points_of(*analytic), {0.05f, 256, 1});
  EXPECT_EQ(truth.visibility.at(0, 0), 1.0f);
}

TEST(RayTracedTruth, InterreflectedLightEqualsVisibilityForBlackWallsAndOneForWhiteWalls) {
  for (const float albedo : {0.0f, 1.0f}) {
    auto analytic = analytic_scene("groove:90");
    analytic->scene.materials[0].base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    const auto rays = RayScene::create(analytic->scene);
    const auto light = interreflection_truth(*rays, points_of(*analytic), {5.0f, 4096, 1});
    const auto open = occlusion_truth(*rays, points_of(*analytic), {5.0f, 4096, 1});
    const float expected = albedo == 0.0f ? open.visibility.at(0, 0) : 1.0f;
    EXPECT_NEAR(light.at(0, 0).g, expected, 0.02f) << albedo;
  }
}

TEST(RayTracedTruth, MirrorIsOccludedIfAWallLiesInTheReflectedViewDirection) {
  // On the floor, a shallow ray towards the wall is reflected into it; one away from it is not.
  const auto analytic = analytic_scene("step");
  const auto rays = RayScene::create(analytic->scene);
  SurfacePoints points{{1, 1, glm::vec3(-0.3f, 0, 0)}, {1, 1, glm::vec3(0, 1, 0)}, {}};
  points.geometric_normal_ws = points.normal_ws;
  const Image<float> roughness(1, 1, 0.05f);
  const Viewer towards{false, {-2.3f, 1.0f, 0.0f}, {}};
  const Viewer away{true, {}, glm::normalize(glm::vec3(0.5f, 1.0f, 0.0f))};
  EXPECT_LT(specular_truth(*rays, points, roughness, towards, {2.0f, 512, 1}).at(0, 0), 0.01f);
  EXPECT_GT(specular_truth(*rays, points, roughness, away, {2.0f, 512, 1}).at(0, 0), 0.99f);
}

TEST(RayTracedTruth, SpecularVisibilityOfAnUnoccludedPlaneIsOne) {
  const auto analytic = analytic_scene("plane:85");
  const auto rays = RayScene::create(analytic->scene);
  const View view = view_of(*rays, analytic->scene.cameras[0], 16, 9);
  for (const float r : {0.05f, 0.3f, 1.0f}) {
    const auto truth = specular_truth(*rays, view.points, Image<float>(16, 9, r),
                                      make_viewer(analytic->scene.cameras[0]), {1.0f, 64, 1});
    for (const float v : truth.pixels) ASSERT_EQ(v, 1.0f) << r;
  }
}

TEST(RayTracedTruth, RaysPassThroughTexelsCutOutByAnAlphaMask) {
  auto analytic = analytic_scene("plane:0");
  Scene& scene = analytic->scene;
  scene.images.push_back({"holes", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
  scene.materials[0].base_color_texture = {0, {Wrap::clamp, Wrap::clamp}};
  scene.materials[0].alpha_mode = AlphaMode::mask;
  for (size_t i = 0; i < scene.meshes[0].uvs.size(); ++i)
    scene.meshes[0].uvs[i] = {scene.meshes[0].positions[i].x > 0.0f ? 1.0f : 0.0f, 0.5f};
  const auto rays = RayScene::create(scene);
  const GBuffer g = cast_gbuffer(*rays, scene.cameras[0], 16, 9);
  EXPECT_EQ(g.material.at(0, 4), 0u);
  EXPECT_EQ(g.material.at(15, 4), kNoMaterial);
}

TEST(HeightFieldTruth, UnoccludedPlaneHasVisibilityOneWithinOne255thInEveryProjection) {
  for (const char* name : {"plane:0", "plane:45", "plane:75"}) {
    auto analytic = analytic_scene(name);
    const auto rays = RayScene::create(analytic->scene);
    for (const bool orthographic : {false, true}) {
      Camera camera = analytic->scene.cameras[0];
      camera.orthographic = orthographic;
      camera.offset_ndc = {0.2f, -0.1f};
      const View view = view_of(*rays, camera, 96, 54);
      const auto truth =
          height_field_truth(view.g.depth_vs, view.g.geometric_normal_ws, camera, {0.5f, 64});
      for (size_t i = 0; i < view.mask.pixels.size(); ++i) {
        // The plane is cut off at the far plane.
        if (view.g.depth_vs.pixels[i] < 0.5f * camera.far_plane) {
          ASSERT_NEAR(truth.visibility.pixels[i], 1.0f, 1.0f / 255.0f) << name << " " << i;
        }
      }
    }
  }
}

// If the image shows all occluders, the height field of a groove or a step equals the scene.
TEST(HeightFieldTruth, HeightFieldVisibilityAgreesWithTheRayTracedOneIfTheImageShowsAllOccluders) {
  for (const char* name : {"groove:90", "groove:120", "step"}) {
    const auto analytic = analytic_scene(name);
    const auto rays = RayScene::create(analytic->scene);
    const Camera& camera = analytic->scene.cameras[0];
    const View view = view_of(*rays, camera, 240, 136);
    const float radius = 0.4f;
    const auto seen =
        height_field_truth(view.g.depth_vs, view.g.geometric_normal_ws, camera, {radius, 64});
    const auto traced = occlusion_truth(*rays, view.points, {radius, 1024, 1});
    Mask middle(240, 136);
    for (uint32_t y = 50; y < 86; ++y)
      for (uint32_t x = 90; x < 150; ++x) middle.at(x, y) = view.mask.at(x, y);
    const ErrorSummary error = compare_images(seen.visibility, traced.visibility, middle);
    EXPECT_LT(error.rmse, 0.03) << name << " bias " << error.bias;
  }
}

TEST(BuiltinScene, BuiltInSceneHasUnder50000TrianglesTwoCamerasAndValidMeshes) {
  const Scene scene = builtin_scene();
  EXPECT_LT(triangle_count(scene), 50000u);
  EXPECT_GE(scene.cameras.size(), 2u);
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_LT(mesh.material, scene.materials.size());
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    ASSERT_EQ(mesh.positions.size(), mesh.uvs.size());
    for (const uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
    for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-4f);
  }
}

}  // namespace
}  // namespace alcove::sample
