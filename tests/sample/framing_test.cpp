#include "scene/framing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

// A grid of 2 n^2 triangles over a square of the given half width, facing up.
Mesh grid(float half_width, uint32_t n, float height = 0.0f) {
  Mesh mesh;
  for (uint32_t z = 0; z <= n; ++z) {
    for (uint32_t x = 0; x <= n; ++x) {
      const glm::vec2 at = 2.0f * half_width * (glm::vec2(x, z) / float(n) - 0.5f);
      mesh.positions.emplace_back(at.x, height, at.y);
      if (x == n || z == n) continue;
      const uint32_t i = z * (n + 1) + x;
      for (const uint32_t v : {i, i + n + 1, i + 1, i + 1, i + n + 1, i + n + 2})
        mesh.indices.push_back(v);
    }
  }
  return mesh;
}

// A sphere of 4 n^2 triangles.
Mesh sphere(float radius, const glm::vec3& centre, uint32_t n) {
  Mesh mesh;
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t k = 0; k <= 2 * n; ++k) {
      const float polar = 3.14159265f * float(i) / float(n);
      const float azimuth = 3.14159265f * float(k) / float(n);
      mesh.positions.push_back(centre + radius * glm::vec3(std::sin(polar) * std::cos(azimuth),
                                                           std::cos(polar),
                                                           std::sin(polar) * std::sin(azimuth)));
      if (i == n || k == 2 * n) continue;
      const uint32_t v = i * (2 * n + 1) + k;
      for (const uint32_t c : {v, v + 1, v + 2 * n + 1, v + 1, v + 2 * n + 2, v + 2 * n + 1})
        mesh.indices.push_back(c);
    }
  }
  return mesh;
}

Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes = std::move(meshes);
  scene.bounds_ws = bounds_of(scene.meshes);
  scene.subject = find_subject(scene);
  return scene;
}

TEST(Framing, WholeExtentOfAnOrdinarySceneIsItsSubject) {
  const Scene scene = builtin_scene();
  const Subject subject = find_subject(scene);
  EXPECT_EQ(subject.triangles_outside, 0u);
  EXPECT_EQ(subject.bounds_ws.low, scene.bounds_ws.low);
  EXPECT_EQ(subject.bounds_ws.high, scene.bounds_ws.high);
}

TEST(Framing, SkyAndGroundAreCountedOutsideTheSubject) {
  const Mesh character = sphere(1.0f, {0, 1, 0}, 16);
  const Scene scene = scene_of({sphere(5000.0f, {0, 0, 0}, 16), grid(1000.0f, 1), character});
  EXPECT_EQ(scene.subject.triangles_outside, 4u * 16 * 16 + 2);
  const Camera camera = with_fitted_planes(scene, framing_camera(scene, 16.0 / 9.0), 16.0 / 9.0);
  EXPECT_LT(glm::distance(camera.eye_ws, camera.target_ws), 10.0f);
  EXPECT_LT(camera.near_plane, 0.1f);
  EXPECT_GT(camera.far_plane, 4000.0f);
}

TEST(Framing, SubjectOfALandscapeIsTheLandscapeAndNotASmallMark) {
  Mesh terrain = grid(500.0f, 100);
  for (size_t i = 0; i < terrain.positions.size(); ++i)
    terrain.positions[i].y = 100.0f * std::sin(0.37f * float(i));
  EXPECT_EQ(scene_of({terrain, sphere(1.0f, {0, 0, 0}, 8)}).subject.triangles_outside, 0u);
}

TEST(Framing, SubjectFillsNineTenthsOfTheWidthOrHeightOfTheImage) {
  for (const glm::vec3 size : {glm::vec3(1, 1, 1), glm::vec3(20, 1, 1), glm::vec3(1, 30, 1)}) {
    for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
      Mesh box = sphere(0.5f, {0, 0, 0}, 8);
      for (glm::vec3& position : box.positions) position = size * position + 7.0f;
      const Scene scene = scene_of({box});
      const auto width = static_cast<uint32_t>(100 * aspect);
      const CameraMatrices matrices = camera_matrices(framing_camera(scene, aspect), width, 100);
      float most = 0.0f;
      for (const glm::vec3& corner : corners_of(scene.subject.bounds_ws)) {
        const glm::vec4 clip = matrices.clip_from_world * glm::vec4(corner, 1.0f);
        most = std::max({most, std::abs(clip.x) / clip.w, std::abs(clip.y) / clip.w});
      }
      EXPECT_NEAR(most, 0.9f, 0.01f) << size.x << " " << size.y << " " << aspect;
    }
  }
}

TEST(DepthInView, TrianglesOutsideTheImageDoNotExtendTheDepthRange) {
  // A floor that reaches behind the eye: the nearest visible point is on the image's lower edge.
  const Scene scene = scene_of({grid(100.0f, 1)});
  Camera camera;
  camera.eye_ws = {0.0f, 2.0f, 0.0f};
  camera.target_ws = {0.0f, 2.0f, -1.0f};
  camera.fov_y = glm::radians(90.0f);
  const auto range = draw_depth(scene, camera, 1.0).range;
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->nearest, 2.0, 1e-4);
  EXPECT_NEAR(range->farthest, 100.0, 1e-3);
  camera.target_ws = {0.0f, 3.0f, 0.01f};
  EXPECT_FALSE(draw_depth(scene, camera, 1.0).range);
}

TEST(DepthInView, InstancesExtendTheDepthRangeAtTheirOwnPositions) {
  Mesh mesh = sphere(1.0f, {0, 0, 0}, 16);
  for (const float z : {-10.0f, -30.0f}) {
    glm::mat4x3 placed(1.0f);
    placed[3] = {0, 0, z};
    mesh.instances.push_back(placed);
  }
  const auto range = draw_depth(scene_of({mesh}), Camera(), 1.0).range;
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->nearest, 9.0, 0.05);
  EXPECT_NEAR(range->farthest, 31.0, 0.05);
}

TEST(DepthInView, LargeTrianglesAreClippedToTheImageBeforeTheirDepthCounts) {
  Mesh mesh;
  mesh.positions = {{-100, 0, -1}, {100, 0, -1}, {0, 0, -201}};
  mesh.indices = {0, 1, 2};
  Camera camera;
  camera.eye_ws = {0, 1, 0};
  camera.target_ws = {0, 1, -1};
  camera.fov_y = glm::radians(90.0f);
  const auto range = draw_depth(scene_of({mesh}), camera, 1.0).range;
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->nearest, 1.0, 1e-4);
  EXPECT_NEAR(range->farthest, 201.0, 1e-2);
}

// A million instances of 4096 triangles: 4 * 10^9 triangles, of which few can be the nearest.
TEST(DepthInView, DepthRangeOfAMillionInstancesIsFoundWithoutSearchingAllTheirTriangles) {
  Mesh mesh = sphere(0.4f, {0, 0, 0}, 32);
  for (int z = 0; z < 1000; ++z) {
    for (int x = -500; x < 500; ++x) {
      glm::mat4x3 placed(1.0f);
      placed[3] = {x, 0, -2 - z};
      mesh.instances.push_back(placed);
    }
  }
  const auto range = draw_depth(scene_of({mesh}), Camera(), 1.0).range;
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->nearest, 1.6, 1e-3);
  EXPECT_NEAR(range->farthest, 1001.4, 1e-3);
}

// The bounding box of every instance is in view, but none of its triangles: they lie in two
// opposite corners of the box, outside the image.
TEST(DepthInView, BeyondTheSearchLimitBoundingBoxesOfInstancesCountInsteadOfTriangles) {
  Mesh mesh;
  for (const float side : {-1.0f, 1.0f}) {
    const Mesh corner = sphere(0.1f, {50 * side, 50 * side, 0}, 64);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corner.positions.begin(), corner.positions.end());
    for (const uint32_t i : corner.indices) mesh.indices.push_back(first + i);
  }
  for (int i = 0; i < 2000; ++i) {
    glm::mat4x3 placed(1.0f);
    placed[3] = {0, 0, -4 - 0.001f * float(i)};
    mesh.instances.push_back(placed);
  }
  const auto range = draw_depth(scene_of({mesh}), Camera(), 1.0).range;
  ASSERT_TRUE(range);
  // The limit is 1024 instances.
  EXPECT_NEAR(range->nearest, 4.0 + 1.024 - 0.1, 0.01);
}

}  // namespace
}  // namespace alcove::sample
