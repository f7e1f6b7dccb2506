#include "scene/outdoor_scenes.h"

#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scene/shapes.h"

namespace alcove::sample {
namespace {

// A linear congruential generator, so that the scenes are the same on every platform.
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  float in(float low, float high) {
    state_ = state_ * 1664525u + 1013904223u;
    return low + (high - low) * static_cast<float>(state_ >> 8u) / 16777216.0f;
  }

 private:
  std::uint32_t state_;
};

glm::mat4 turned(float angle) { return glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0)); }

// A bush: leaves on the surface of a sphere and inside it, and a few stems.
void add_bush(SceneBuilder& b, std::uint32_t leaf, std::uint32_t wood, glm::vec3 centre,
              float radius, int leaves, Random& random) {
  b.world_from_shape = glm::mat4(1.0f);
  b.use(wood);
  for (int i = 0; i < 7; ++i) {
    const glm::vec3 tip{random.in(-0.6f, 0.6f), random.in(-0.2f, 0.6f), random.in(-0.6f, 0.6f)};
    b.bar({centre.x, 0.0f, centre.z}, centre + radius * tip, 0.02f);
  }
  b.use(leaf);
  for (int i = 0; i < leaves; ++i) {
    const float height = random.in(-1.0f, 1.0f);
    const float angle = random.in(0.0f, glm::two_pi<float>());
    const float flat = std::sqrt(1.0f - height * height);
    const glm::vec3 out{flat * std::cos(angle), height, flat * std::sin(angle)};
    const glm::vec3 at = centre + out * (radius * std::sqrt(random.in(0.2f, 1.0f)));
    if (at.y < 0.05f) continue;
    b.world_from_shape = glm::rotate(
        glm::rotate(translation(at), random.in(0.0f, glm::two_pi<float>()), glm::vec3(0, 1, 0)),
        random.in(-1.2f, 1.2f), glm::vec3(1, 0, 0));
    const float length = random.in(0.05f, 0.09f);
    const float width = 0.45f * length;
    b.quad({-width, 0, 0}, {0, 0, length}, {width, 0, 0}, {0, 0, -length});
  }
}

// A tuft of grass: blades that lean outwards.
void add_tuft(SceneBuilder& b, glm::vec3 at, Random& random) {
  for (int i = 0; i < 9; ++i) {
    b.world_from_shape = translation(at) * turned(random.in(0.0f, glm::two_pi<float>()));
    const float height = random.in(0.1f, 0.28f);
    const float lean = random.in(0.02f, 0.12f);
    b.triangle({-0.008f, 0.0f, 0.02f}, {0.008f, 0.0f, 0.02f}, {0.0f, height, lean});
  }
}

void add_fence(SceneBuilder& b, std::uint32_t paint) {
  constexpr float kPitch = 0.14f;
  b.world_from_shape = glm::mat4(1.0f);
  b.use(paint);
  for (int i = -36; i <= 36; ++i) {
    const float x = kPitch * static_cast<float>(i);
    b.box({x - 0.035f, 0.06f, -0.01f}, {x + 0.035f, 1.12f, 0.01f});
    b.quad({x - 0.035f, 1.12f, 0.0f}, {x + 0.035f, 1.12f, 0.0f}, {x, 1.19f, 0.0f},
           {x, 1.19f, 0.0f});
    if (i % 12 == 0) b.box({x - 0.05f, 0.0f, -0.14f}, {x + 0.05f, 1.25f, -0.05f});
  }
  for (const float y : {0.3f, 0.9f}) b.box({-5.1f, y, -0.05f}, {5.1f, y + 0.08f, -0.01f});
}

// Height of the terrain at a point.
float terrain_height(float x, float z) {
  return 1.6f * std::sin(0.13f * x + 0.4f) * std::cos(0.11f * z) +
         0.5f * std::sin(0.37f * x + 0.21f * z) + 0.16f * std::cos(0.9f * z - 0.7f * x) +
         0.05f * std::sin(2.3f * x) * std::sin(2.1f * z);
}

glm::vec3 on_terrain(float x, float z) { return {x, terrain_height(x, z), z}; }

glm::vec3 terrain_normal(float x, float z) {
  constexpr float kStep = 0.05f;
  const float dx = terrain_height(x + kStep, z) - terrain_height(x - kStep, z);
  const float dz = terrain_height(x, z + kStep) - terrain_height(x, z - kStep);
  return glm::normalize(glm::vec3(-dx, 2.0f * kStep, -dz));
}

void add_ground(SceneBuilder& b) {
  constexpr int kCells = 120;
  constexpr float kSide = 80.0f;
  const auto at = [](int cell) {
    return kSide * (static_cast<float>(cell) / static_cast<float>(kCells) - 0.5f);
  };
  b.world_from_shape = glm::mat4(1.0f);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const glm::vec2 corners[4] = {
          {at(i), at(j + 1)}, {at(i + 1), at(j + 1)}, {at(i + 1), at(j)}, {at(i), at(j)}};
      glm::vec3 positions[4];
      glm::vec3 normals[4];
      for (int k = 0; k < 4; ++k) {
        positions[k] = on_terrain(corners[k].x, corners[k].y);
        normals[k] = terrain_normal(corners[k].x, corners[k].y);
      }
      b.smooth_quad(positions, normals);
    }
  }
}

// A conifer: a trunk and four cones.
void add_tree(SceneBuilder& b, std::uint32_t wood, std::uint32_t leaf, glm::vec3 at, float height) {
  b.world_from_shape = glm::scale(translation(at), glm::vec3(height));
  b.use(wood);
  const std::vector<glm::vec2> trunk = {{0.03f, -0.05f}, {0.025f, 0.3f}, {0.0f, 0.6f}};
  b.lathe(trunk, 8);
  b.use(leaf);
  for (int i = 0; i < 4; ++i) {
    const float low = 0.15f + 0.19f * static_cast<float>(i);
    const float wide = 0.24f - 0.05f * static_cast<float>(i);
    const std::vector<glm::vec2> cone = {{0.02f, low + 0.04f}, {wide, low}, {0.0f, low + 0.32f}};
    b.lathe(cone, 12);
  }
}

void add_hut(SceneBuilder& b, std::uint32_t wall, std::uint32_t roof, glm::vec3 at) {
  b.world_from_shape = translation(at) * turned(0.5f);
  b.use(wall);
  b.box({-2.0f, -1.0f, -1.5f}, {2.0f, 2.0f, -1.35f});
  b.box({-2.0f, -1.0f, -1.5f}, {-1.85f, 2.0f, 1.5f});
  b.box({1.85f, -1.0f, -1.5f}, {2.0f, 2.0f, 1.5f});
  b.box({-2.0f, -1.0f, 1.35f}, {-0.5f, 2.0f, 1.5f});
  b.box({0.5f, -1.0f, 1.35f}, {2.0f, 2.0f, 1.5f});
  b.use(roof);
  for (const float side : {-1.0f, 1.0f}) {
    const glm::vec3 low{0, 1.9f, side * 2.0f};
    const glm::vec3 high{0, 3.1f, 0};
    const glm::vec3 along{side * 2.4f, 0, 0};
    b.quad(low - along, low + along, high + along, high - along);
  }
}

}  // namespace

Scene fence_scene() {
  SceneBuilder b;
  Random random(7);
  const std::uint32_t soil = b.add_material("soil", {0.32f, 0.28f, 0.2f}, 0.9f);
  const std::uint32_t plaster = b.add_material("plaster", {0.75f, 0.72f, 0.66f}, 0.8f);
  const std::uint32_t paint = b.add_material("paint", {0.85f, 0.85f, 0.82f}, 0.4f);
  const std::uint32_t wood = b.add_material("wood", {0.3f, 0.2f, 0.13f}, 0.7f);
  const std::uint32_t leaf = b.add_material("leaf", {0.2f, 0.42f, 0.12f}, 0.5f);
  const std::uint32_t grass = b.add_material("grass", {0.28f, 0.45f, 0.15f}, 0.6f);
  b.use(soil);
  b.box({-12.0f, -0.2f, -6.0f}, {12.0f, 0.0f, 8.0f});
  b.use(plaster);
  b.box({-8.0f, 0.0f, -2.4f}, {8.0f, 2.6f, -2.1f});
  add_fence(b, paint);
  add_bush(b, leaf, wood, {-1.6f, 0.75f, -1.1f}, 0.75f, 2600, random);
  add_bush(b, leaf, wood, {0.5f, 0.6f, -1.2f}, 0.6f, 1900, random);
  add_bush(b, leaf, wood, {2.6f, 0.85f, -1.0f}, 0.8f, 2800, random);
  add_bush(b, leaf, wood, {-0.7f, 0.45f, 0.9f}, 0.42f, 1200, random);
  b.use(grass);
  for (int i = 0; i < 900; ++i)
    add_tuft(b, {random.in(-5.0f, 5.0f), 0.0f, random.in(-2.0f, 2.6f)}, random);
  Scene scene = b.finish("fence");
  scene.suggested_radius = 0.5f;
  scene.cameras = {scene_camera("fence", {-2.6f, 1.3f, 3.0f}, {0.2f, 0.55f, -0.4f}, 60.0f, 60.0f),
                   scene_camera("bush", {0.2f, 0.8f, 2.3f}, {-0.8f, 0.4f, 0.2f}, 60.0f, 60.0f),
                   scene_camera("along", {-4.4f, 1.0f, 0.7f}, {2.0f, 0.6f, -0.3f}, 60.0f, 60.0f)};
  return scene;
}

Scene terrain_scene() {
  SceneBuilder b;
  Random random(11);
  const std::uint32_t soil = b.add_material("soil", {0.36f, 0.38f, 0.24f}, 0.9f);
  const std::uint32_t stone = b.add_material("stone", {0.5f, 0.48f, 0.45f}, 0.8f);
  const std::uint32_t wood = b.add_material("wood", {0.35f, 0.24f, 0.15f}, 0.7f);
  const std::uint32_t leaf = b.add_material("leaf", {0.14f, 0.3f, 0.14f}, 0.6f);
  b.use(soil);
  add_ground(b);
  for (int i = 0; i < 90; ++i) {
    const glm::vec3 at = on_terrain(random.in(-34.0f, 34.0f), random.in(-34.0f, 20.0f));
    const float size = random.in(0.15f, 1.1f);
    b.world_from_shape =
        glm::scale(translation(at) * turned(random.in(0.0f, 3.0f)),
                   size * glm::vec3(1.0f, random.in(0.5f, 0.9f), random.in(0.6f, 1.0f)));
    b.use(stone);
    b.sphere({0, 0, 0}, 1.0f, 6, 9);
  }
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 at = on_terrain(random.in(-36.0f, 36.0f), random.in(-36.0f, 8.0f));
    add_tree(b, wood, leaf, at, random.in(2.0f, 5.5f));
  }
  add_hut(b, wood, stone, on_terrain(3.0f, -3.0f));
  b.world_from_shape = glm::mat4(1.0f);
  b.use(wood);
  for (int i = 0; i < 14; ++i) {
    const glm::vec3 at =
        on_terrain(-9.0f + 1.3f * static_cast<float>(i), 4.0f - 0.5f * static_cast<float>(i));
    b.bar(at - glm::vec3(0, 0.2f, 0), at + glm::vec3(0, 1.2f, 0), 0.1f);
  }
  Scene scene = b.finish("terrain");
  scene.suggested_radius = 1.0f;
  scene.cameras = {
      scene_camera("valley", {-5.0f, 4.6f, 15.0f}, {1.0f, 0.6f, -4.0f}, 60.0f, 200.0f),
      scene_camera("hut", {9.0f, 2.8f, 3.0f}, {3.0f, 1.2f, -3.0f}, 60.0f, 200.0f),
      scene_camera("ridge", {-20.0f, 5.5f, 2.0f}, {6.0f, 0.0f, -14.0f}, 60.0f, 200.0f)};
  return scene;
}

}  // namespace alcove::sample
