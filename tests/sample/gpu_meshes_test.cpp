#include "render/gpu_meshes.h"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include "quad_test.h"
#include "reference/truth.h"
#include "scene/analytic_scenes.h"

namespace alcove::sample {
namespace {

// A cube of side 1 around the origin whose eight vertices are shared by all of its triangles.
Mesh cube() {
  Mesh mesh;
  mesh.positions.resize(8);
  for (std::uint32_t i = 0; i < 8; ++i)
    for (int c = 0; c < 3; ++c) mesh.positions[i][c] = (i >> c & 1u) != 0 ? 0.5f : -0.5f;
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

std::vector<glm::mat4x3> placements() {
  std::vector<glm::mat4x3> out;
  for (int i = 0; i < 5; ++i) {
    const glm::mat4 moved = glm::translate(glm::mat4(1.0f), {0.35f * float(i - 2), 0.0f, 0.0f});
    const glm::mat4 turned = glm::rotate(moved, 0.7f * float(i), {1.0f, 2.0f, 3.0f});
    const float mirror = i % 2 == 1 ? -1.0f : 1.0f;
    out.emplace_back(glm::scale(turned, {0.3f * mirror, 0.2f, 0.4f}));
  }
  return out;
}

Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].double_sided = false;
  scene.meshes = std::move(meshes);
  scene.bounds_ws = bounds_of(scene.meshes);
  return scene;
}

// The cubes of placements() as instances of one mesh, and as meshes of their own.
Scene instanced_cubes() {
  Mesh mesh = cube();
  mesh.instances = placements();
  return scene_of({mesh});
}

Scene separate_cubes() {
  std::vector<Mesh> meshes;
  for (const glm::mat4x3& placed : placements()) {
    Mesh mesh = cube();
    for (glm::vec3& position : mesh.positions) position = placed * glm::vec4(position, 1.0f);
    if (glm::determinant(glm::mat3(placed)) < 0.0f)
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    meshes.push_back(mesh);
  }
  return scene_of(meshes);
}

class GpuMeshesTest : public QuadTest {};

TEST_F(GpuMeshesTest, MeshIsSplitIfABufferWouldExceedTheSizeLimit) {
  auto sphere = analytic_scene("sphere");
  ASSERT_TRUE(sphere);
  constexpr VkDeviceSize kLimit = 4096;
  const auto whole = GpuMeshes::create(gpu().device(), sphere->scene);
  const auto split = GpuMeshes::create(gpu().device(), sphere->scene, kLimit);
  ASSERT_TRUE(whole && split);
  std::uint64_t whole_indices = 0, split_indices = 0;
  for (const MeshDraw& draw : (*whole)->draws()) whole_indices += draw.index_count;
  for (const MeshDraw& draw : (*split)->draws()) split_indices += draw.index_count;
  EXPECT_EQ(whole_indices, 3 * triangle_count(sphere->scene));
  EXPECT_EQ(split_indices, whole_indices);
  EXPECT_GT((*split)->draws().size(), (*whole)->draws().size());
  EXPECT_LE((*split)->bytes(), kLimit * (*split)->buffers());
}

TEST_F(GpuMeshesTest, ErrorForABufferOverTheAllocationLimitNamesTheLimit) {
  const VkDeviceSize limit = gpu().device().max_allocation();
  const auto buffer =
      HostBuffer::create(gpu().device(), limit + 1, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  ASSERT_FALSE(buffer);
  EXPECT_THAT(buffer.error(), testing::HasSubstr(std::to_string(limit)));
}

TEST_F(GpuMeshesTest, GridTakesUnder40BytesPerTriangleAndAbout48BytesPerInstance) {
  Mesh grid;
  constexpr std::uint32_t kSide = 300;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      grid.positions.emplace_back(x, y, 0.0f);
      grid.normals.emplace_back(0.0f, 0.0f, 1.0f);
      if (x == 0 || y == 0) continue;
      const std::uint32_t i = y * kSide + x;
      for (const std::uint32_t v : {i - kSide - 1, i - kSide, i, i - kSide - 1, i, i - 1})
        grid.indices.push_back(v);
    }
  }
  const auto bytes = [&](std::size_t instances) {
    grid.instances.assign(instances, glm::mat4x3(1.0f));
    const auto meshes = GpuMeshes::create(gpu().device(), scene_of({grid}), 1u << 18);
    EXPECT_TRUE(meshes);
    return meshes ? static_cast<double>((*meshes)->bytes()) : 0.0;
  };
  const auto triangles = static_cast<double>(grid.indices.size() / 3);
  EXPECT_LT(bytes(1) / triangles, 40.0);
  EXPECT_NEAR((bytes(100'001) - bytes(1)) / 1e5, 48.0, 5.0);
}

TEST_F(GpuMeshesTest, TrianglesWithSharedVerticesKeepTheirOwnGeometricNormals) {
  const Scene scene = scene_of({cube()});
  Camera camera = camera_at(3.0f);
  camera.eye_ws = {2.0f, 1.5f, 3.0f};
  const FrameImages images = draw(scene, 32, camera, NormalSource::geometric);
  int faces = 0;
  for (const glm::vec3& n : images.normal_ws.pixels) {
    if (n == glm::vec3(0.0f)) continue;
    ++faces;
    EXPECT_NEAR(std::max({n.x, n.y, n.z}), 1.0f, 1e-3f);
  }
  EXPECT_GT(faces, 100);
}

TEST_F(GpuMeshesTest, InstancesAreDrawnAndTracedLikeSeparateMeshes) {
  const Scene instanced = instanced_cubes();
  const Scene separate = separate_cubes();
  Camera camera = camera_at(3.0f);
  camera.eye_ws = {0.5f, 1.0f, 3.0f};
  constexpr std::uint32_t kSize = 64;
  const FrameImages one = draw(instanced, kSize, camera);
  const FrameImages other = draw(separate, kSize, camera);
  const auto traced = RayScene::create(instanced);
  const auto traced_apart = RayScene::create(separate);
  ASSERT_TRUE(traced && traced_apart);
  const GBuffer cast = cast_gbuffer(*traced, camera, kSize, kSize);
  const GBuffer cast_apart = cast_gbuffer(*traced_apart, camera, kSize, kSize);
  int surfaces = 0;
  for (std::size_t i = 0; i < one.depth_ndc.pixels.size(); ++i) {
    EXPECT_NEAR(one.depth_ndc.pixels[i], other.depth_ndc.pixels[i], 1e-5f);
    EXPECT_LT(glm::distance(one.normal_ws.pixels[i], other.normal_ws.pixels[i]), 2e-3f);
    EXPECT_LT(
        glm::distance(cast.shading_normal_ws.pixels[i], cast_apart.shading_normal_ws.pixels[i]),
        1e-4f);
    if (one.depth_ndc.pixels[i] != 1.0f) ++surfaces;
  }
  EXPECT_GT(surfaces, 100);
}

TEST_F(GpuMeshesTest, BackFacesOfSingleSidedMaterialsAreNeitherDrawnNorTraced) {
  Scene scene = plain_quad();
  for (const bool double_sided : {false, true}) {
    scene.materials[0].double_sided = double_sided;
    const auto traced = RayScene::create(scene);
    ASSERT_TRUE(traced);
    for (const float z : {3.0f, -3.0f}) {
      const bool visible = double_sided || z > 0.0f;
      const FrameImages images = draw(scene, 8, camera_at(z));
      const GBuffer cast = cast_gbuffer(*traced, camera_at(z), 8, 8);
      for (std::size_t i = 0; i < images.depth_ndc.pixels.size(); ++i) {
        EXPECT_EQ(images.depth_ndc.pixels[i] != 1.0f, visible);
        EXPECT_EQ(cast.material.pixels[i] != kNoMaterial, visible);
      }
    }
  }
}

}  // namespace
}  // namespace alcove::sample
