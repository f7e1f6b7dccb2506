// Renders a quad with a normal map and reads back the normals that the occlusion pass and the
// truths get.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "quad_test.h"
#include "reference/surface_points.h"
#include "reference/truth.h"
#include "scene/tangents.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 16;
constexpr float kByte = 1.0f / 127.0f;  // quantisation step of an 8-bit map

// The normal in the map of these tests, after quantisation: to the right, up and towards the
// viewer.
const glm::vec3 kTilt(0.48f, 0.36f, 0.8f);

TextureImage map_of(const glm::vec3& normal) {
  TextureImage image{"map", 1, 1, {0, 0, 0, 255}};
  for (int c = 0; c < 3; ++c) {
    image.rgba[static_cast<std::size_t>(c)] =
        static_cast<std::uint8_t>(std::lround(127.5f * (normal[c] + 1.0f)));
  }
  return image;
}

Scene quad(const glm::vec3& normal = kTilt) {
  Scene scene = plain_quad();
  scene.images.push_back(map_of(normal));
  scene.materials[0].normal_texture.image = 0;
  return scene;
}

class NormalMap : public QuadTest {
 protected:
  FrameImages draw(const Scene& scene, const Camera& camera = camera_at(3.0f),
                   NormalSource normals = NormalSource::shading) {
    return QuadTest::draw(scene, kSize, camera, normals);
  }

  // Checks the normal at every pixel of the quad, which fills the picture.
  static void expect_normal(const FrameImages& images, const glm::vec3& normal) {
    ASSERT_EQ(images.normal_ws.pixels.size(), std::size_t{kSize} * kSize);
    for (const glm::vec3& n : images.normal_ws.pixels) {
      ASSERT_NEAR(glm::length(n), 1.0f, 2e-3f);
      ASSERT_LT(glm::distance(n, glm::normalize(normal)), kByte) << n.x << ' ' << n.y << ' ' << n.z;
    }
  }
};

TEST_F(NormalMap, RedChannelTiltsNormalsAlongUAndGreenAgainstV) {
  expect_normal(draw(quad()), kTilt);
}

TEST_F(NormalMap, NormalScaleMultipliesOnlyXAndYOfTheMappedNormal) {
  for (const float scale : {-1.0f, 0.0f, 0.5f, 1e6f}) {
    Scene scene = quad();
    scene.materials[0].normal_scale = scale;
    expect_normal(draw(scene), kTilt * glm::vec3(scale, scale, 1.0f));
  }
}

TEST_F(NormalMap, TangentsGivenByTheMeshDetermineTheDirectionInWhichNormalsTilt) {
  Scene scene = quad();
  scene.meshes[0].tangents.assign(6, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  expect_normal(draw(scene), kTilt);
  scene.meshes[0].tangents.assign(6, glm::vec4(-1.0f, 0.0f, 0.0f, -1.0f));
  expect_normal(draw(scene), kTilt * glm::vec3(-1.0f, 1.0f, 1.0f));
}

TEST_F(NormalMap, MirroredTextureHalvesWithSharedVerticesTiltInOppositeDirections) {
  Scene scene = quad();
  for (glm::vec2& uv : scene.meshes[0].uvs) uv.x = std::abs(uv.x - 0.5f);
  const FrameImages images = draw(scene);
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const glm::vec3 normal = kTilt * glm::vec3(x < kSize / 2 ? -1.0f : 1.0f, 1.0f, 1.0f);
      EXPECT_LT(glm::distance(images.normal_ws.at(x, y), normal), kByte) << x << ' ' << y;
    }
  }
}

TEST_F(NormalMap, TextureTransformRotatesTheTiltOfMappedNormals) {
  Scene scene = quad();
  // The transform maps u of the mesh to -v of the map, and v of the mesh to u of the map.
  scene.materials[0].normal_texture.texture_from_mesh_uv = {0.0f, -1.0f, 1.0f, 0.0f, 0.0f, 1.0f};
  expect_normal(draw(scene), {kTilt.y, -kTilt.x, kTilt.z});
}

TEST_F(NormalMap, MappedNormalsAreFlippedOnBackFaces) {
  expect_normal(draw(quad(), camera_at(-3.0f)), -kTilt);
}

TEST_F(NormalMap, VertexNormalIsKeptWhereTextureCoordinatesSpanNoAreaOrTangentsAreInvalid) {
  Scene scene = quad();
  for (glm::vec2& uv : scene.meshes[0].uvs) uv = glm::vec2(0.25f);
  expect_normal(draw(scene), {0.0f, 0.0f, 1.0f});
  scene = quad();
  scene.meshes[0].tangents.assign(6, glm::vec4(0.0f));
  expect_normal(draw(scene), {0.0f, 0.0f, 1.0f});
  scene.meshes[0].tangents.assign(6, glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
  expect_normal(draw(scene), {0.0f, 0.0f, 1.0f});
}

TEST_F(NormalMap, MappedNormalsAreLimitedToTheHemisphereOfTheFace) {
  expect_normal(draw(quad({0.6f, 0.0f, -0.8f})), {1.0f, 0.0f, 0.0f});
  // The normal in the map points straight into the surface, so that rounding decides its direction
  // in the surface.
  for (const glm::vec3& n : draw(quad({0.0f, 0.0f, -1.0f})).normal_ws.pixels) {
    EXPECT_NEAR(glm::length(n), 1.0f, 2e-3f);
    EXPECT_GT(n.z, -1e-3f);
  }
}

TEST_F(NormalMap, OppositeNormalTiltsCancelWhereTexelsAreSmallerThanPixels) {
  Scene scene = quad();
  TextureImage& map = scene.images[0];
  const TextureImage right = map_of(kTilt), left = map_of(kTilt * glm::vec3(-1.0f, -1.0f, 1.0f));
  map = {"ripples", 8 * kSize, 8 * kSize, {}};
  for (std::uint32_t i = 0; i < map.width * map.height; ++i) {
    const std::vector<std::uint8_t>& texel = i % 2 == 0 ? right.rgba : left.rgba;
    map.rgba.insert(map.rgba.end(), texel.begin(), texel.end());
  }
  expect_normal(draw(scene), {0.0f, 0.0f, 1.0f});
}

TEST_F(NormalMap, NormalMapAffectsShadingNormalsOnly) {
  expect_normal(draw(quad(), camera_at(3.0f), NormalSource::geometric), {0.0f, 0.0f, 1.0f});
}

TEST_F(NormalMap, RayTracedTruthUsesTheMappedNormalsThatTheOcclusionPassIsGiven) {
  const Scene scene = quad();
  const Camera camera = camera_at(3.0f);
  const FrameImages images = draw(scene, camera);
  const auto rays = RayScene::create(scene);
  ASSERT_TRUE(rays);
  const auto points =
      surface_points(*rays, camera, images.normal_ws, linear_depth(camera, images.depth_ndc));
  const auto truth = occlusion_truth(*rays, points, {.radius = 0.2f, .spp = 1024}, nullptr);
  // A plane leaves (1 + cos) / 2 of the cosine lobe around a tilted normal visible.
  EXPECT_NEAR(truth.visibility.at(kSize / 2, kSize / 2), 0.5f * (1.0f + kTilt.z), 0.01f);
}

TEST_F(NormalMap, AlphaMasksFollowTheirTextureTransformInRasteriserAndRayTracer) {
  Scene scene = quad();
  Material& material = scene.materials[0];
  material.normal_texture = {};
  material.alpha_mode = AlphaMode::mask;
  // The mask is opaque left of the middle. The transform doubles the coordinates and rotates them
  // by 90 degrees, which gives strips.
  scene.images[0] = {"mask", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}};
  material.base_color_texture.image = 0;
  material.base_color_texture.texture_from_mesh_uv = {0.0f, -2.0f, 2.0f, 0.0f, 0.0f, 1.0f};
  const Camera camera = camera_at(3.0f);
  const Image<float> drawn = linear_depth(camera, draw(scene, camera).depth_ndc);
  const auto rays = RayScene::create(scene);
  ASSERT_TRUE(rays);
  const Image<float> traced = cast_gbuffer(*rays, camera, kSize, kSize).depth_vs;
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const bool solid = y % (kSize / 2) < kSize / 4;
      EXPECT_EQ(std::isfinite(drawn.at(x, y)), solid) << x << ' ' << y;
      EXPECT_EQ(std::isfinite(traced.at(x, y)), solid) << x << ' ' << y;
    }
  }
}

TEST(Tangents, TangentsOfACurvedMeshAreUnitVectorsPerpendicularToItsNormals) {
  Scene scene = quad();
  Mesh& mesh = scene.meshes[0];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const float angle = 0.5f * std::numbers::pi_v<float> * mesh.positions[v].x;
    mesh.normals[v] = {std::sin(angle), 0.0f, std::cos(angle)};
    mesh.positions[v] = {std::sin(angle), mesh.positions[v].y, std::cos(angle)};
  }
  const std::vector<glm::vec4> tangents = corner_tangents(mesh, {});
  ASSERT_EQ(tangents.size(), mesh.indices.size());
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const glm::vec3 normal = mesh.normals[mesh.indices[i]];
    const glm::vec3 along(normal.z, 0.0f, -normal.x);
    EXPECT_LT(glm::distance(glm::vec3(tangents[i]), along), 1e-5f) << i;
    EXPECT_EQ(tangents[i].w, 1.0f);
  }
}

// MikkTSpace merges corners with equal values, so that shared and unshared vertices give the same
// tangents.
TEST(Tangents, MeshesWithSharedAndWithUnsharedVerticesGetTheSameTangents) {
  Scene scene = quad();
  const Mesh shared = scene.meshes[0];
  Mesh apart = shared;
  apart.positions.clear();
  apart.normals.clear();
  apart.uvs.clear();
  apart.indices.clear();
  for (const std::uint32_t v : shared.indices) {
    apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
    apart.positions.push_back(shared.positions[v]);
    apart.normals.push_back(shared.normals[v]);
    apart.uvs.push_back(shared.uvs[v]);
  }
  const auto one = corner_tangents(shared, {}), other = corner_tangents(apart, {});
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i], other[i]);
}

TEST(Tangents, TrianglesThatMeetOnlyInAVertexDoNotShareItsTangent) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  mesh.normals.assign(5, glm::vec3(0, 0, 1));
  // In the second triangle u runs along y. Its mapping is mirrored, like that of the first one.
  mesh.uvs = {{0, 0}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}};
  mesh.indices = {0, 1, 2, 0, 3, 4};
  const auto tangents = corner_tangents(mesh, {});
  EXPECT_EQ(tangents[0], glm::vec4(1, 0, 0, 1));
  EXPECT_LT(glm::distance(glm::vec3(tangents[3]), glm::vec3(0, 1, 0)), 1e-6f);
}

// A triangle without area in the texture gets the tangents of its neighbour.
TEST(Tangents, TriangleWithoutAreaInTheTextureGetsTheTangentOfItsNeighbour) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, glm::vec3(0, 0, 1));
  mesh.uvs = {{0, 0}, {1, 0}, {1, -1}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const auto tangents = corner_tangents(mesh, {});
  for (const std::size_t corner : {0u, 1u, 2u, 3u, 4u})
    EXPECT_EQ(tangents[corner], glm::vec4(1, 0, 0, 1)) << corner;
}

}  // namespace
}  // namespace alcove::sample
