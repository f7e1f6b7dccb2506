#include "scene/builtin_scene.h"

#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scene/shapes.h"

namespace alcove::sample {
namespace {

// The arcade extends along the x axis. The courtyard is in front of it at +z, the back wall behind
// it at -z.
constexpr int kBays = 8;
constexpr float kBay = 2.2f;  // from column to column
constexpr float kEnd = 0.5f * kBay * kBays;
constexpr float kWall = -3.0f;       // face of the back wall
constexpr float kSpring = 2.5f;      // where the arches spring
constexpr float kEaves = 4.1f;       // top of the arcade
constexpr float kThickness = 0.42f;  // of the arcade's wall

struct Palette {
  uint32_t plaster, ceiling, marble, tile_light, tile_dark, step, terracotta, leaf, wood, bronze,
      ceramic, gilt;
};

Palette add_palette(SceneBuilder& b) {
  Palette p;
  p.plaster = b.add_material("plaster", {0.78f, 0.68f, 0.54f}, 0.90f);
  p.ceiling = b.add_material("ceiling", {0.88f, 0.86f, 0.80f}, 0.80f);
  p.marble = b.add_material("marble", {0.72f, 0.70f, 0.68f}, 0.30f);
  p.tile_light = b.add_material("light tile", {0.62f, 0.55f, 0.45f}, 0.20f);
  p.tile_dark = b.add_material("dark tile", {0.16f, 0.13f, 0.12f}, 0.15f);
  p.step = b.add_material("step", {0.52f, 0.50f, 0.47f}, 0.70f);
  p.terracotta = b.add_material("terracotta", {0.58f, 0.25f, 0.14f}, 0.65f);
  p.leaf = b.add_material("leaf", {0.10f, 0.28f, 0.07f}, 0.45f);
  p.wood = b.add_material("wood", {0.32f, 0.19f, 0.10f}, 0.60f);
  p.bronze = b.add_material("bronze", {0.65f, 0.45f, 0.26f}, 0.35f, 1.0f);
  p.ceramic = b.add_material("ceramic", {0.12f, 0.25f, 0.48f}, 0.08f);
  p.gilt = b.add_material("gilt", {0.90f, 0.70f, 0.30f}, 0.20f, 1.0f);
  return p;
}

glm::mat4 turned(const glm::mat4& m, float degrees) {
  return glm::rotate(m, glm::radians(degrees), glm::vec3(0, 1, 0));
}

// The floor of the walk in two colours, its steps down, and the court.
void add_floor(SceneBuilder& b, const Palette& p) {
  b.world_from_shape = glm::mat4(1.0f);
  constexpr float kTile = 0.55f;
  const int columns = static_cast<int>(2.0f * kEnd / kTile), rows = 6;
  const float width = 2.0f * kEnd / static_cast<float>(columns);
  const float depth = (0.35f - kWall) / static_cast<float>(rows);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      b.use((i + j) % 2 ? p.tile_dark : p.tile_light);
      const float x = -kEnd + width * static_cast<float>(i);
      const float z = kWall + depth * static_cast<float>(j);
      b.quad({x, 0, z + depth}, {x + width, 0, z + depth}, {x + width, 0, z}, {x, 0, z});
    }
  }
  b.use(p.step);
  for (int s = 0; s < 3; ++s) {
    const float front = 0.35f + 0.32f * static_cast<float>(s);
    b.box({-kEnd, -0.51f, front}, {kEnd, -0.17f * static_cast<float>(s), front + 0.32f});
  }
  b.quad({-kEnd, -0.51f, 9.0f}, {kEnd, -0.51f, 9.0f}, {kEnd, -0.51f, 1.31f},
         {-kEnd, -0.51f, 1.31f});
}

// A round column on a square plinth, in the axis of the arcade.
void add_column(SceneBuilder& b, const Palette& p, float x) {
  b.world_from_shape = translation({x, 0, 0});
  b.use(p.step);
  b.box({-0.25f, 0.0f, -0.25f}, {0.25f, 0.14f, 0.25f});
  b.use(p.marble);
  const std::vector<glm::vec2> profile = {
      {0.25f, 0.14f},  {0.255f, 0.17f}, {0.24f, 0.21f}, {0.20f, 0.22f}, {0.195f, 0.26f},
      {0.22f, 0.28f},  {0.22f, 0.31f},  {0.19f, 0.33f}, {0.17f, 0.38f}, {0.172f, 0.90f},
      {0.165f, 1.60f}, {0.148f, 2.16f}, {0.17f, 2.18f}, {0.17f, 2.21f}, {0.15f, 2.22f},
      {0.155f, 2.28f}, {0.19f, 2.34f},  {0.24f, 2.38f}};
  b.lathe(profile, 28);
  b.use(p.step);
  b.box({-0.27f, 2.38f, -0.27f}, {0.27f, kSpring, 0.27f});
}

// The row of arches towards the court, with a string course and a cornice.
void add_arcade(SceneBuilder& b, const Palette& p) {
  b.use(p.plaster);
  for (int bay = 0; bay < kBays; ++bay) {
    const float x = -kEnd + kBay * (static_cast<float>(bay) + 0.5f);
    b.world_from_shape = translation({x, 0, 0});
    b.arch({-0.5f * kBay, kSpring}, {0.5f * kBay, kEaves}, 0.5f * kBay - 0.22f, kThickness, 28);
  }
  b.world_from_shape = glm::mat4(1.0f);
  b.use(p.step);
  b.box({-kEnd, 3.72f, 0.5f * kThickness}, {kEnd, 3.80f, 0.5f * kThickness + 0.06f});
  b.box({-kEnd, kEaves, -0.5f * kThickness}, {kEnd, kEaves + 0.14f, 0.5f * kThickness + 0.22f});
}

// The wall behind the walk: pilasters, niches and a plinth.
void add_back_wall(SceneBuilder& b, const Palette& p) {
  b.world_from_shape = glm::mat4(1.0f);
  b.use(p.plaster);
  constexpr float kNiche = 0.35f;  // depth
  for (int bay = 0; bay < kBays; ++bay) {
    const float x = -kEnd + kBay * (static_cast<float>(bay) + 0.5f);
    const float half = 0.5f * kBay;
    b.world_from_shape = translation({x, 0, kWall - 0.5f * kNiche});
    b.arch({-half, 1.7f}, {half, kEaves}, 0.62f, kNiche, 24);
    b.box({-half, 0.0f, -0.5f * kNiche}, {-0.62f, 1.7f, 0.5f * kNiche});
    b.box({0.62f, 0.0f, -0.5f * kNiche}, {half, 1.7f, 0.5f * kNiche});
    b.box({-0.62f, 0.0f, -0.5f * kNiche}, {0.62f, 0.55f, 0.5f * kNiche});
    b.quad({-half, 0.0f, -0.5f * kNiche}, {half, 0.0f, -0.5f * kNiche},
           {half, kEaves, -0.5f * kNiche}, {-half, kEaves, -0.5f * kNiche});
  }
  for (int i = 0; i <= kBays; ++i) {
    b.world_from_shape = translation({-kEnd + kBay * static_cast<float>(i), 0, kWall});
    b.use(p.plaster);
    b.box({-0.2f, 0.0f, 0.0f}, {0.2f, 2.38f, 0.14f});
    b.use(p.step);
    b.box({-0.24f, 2.38f, 0.0f}, {0.24f, kSpring, 0.2f});
    b.box({-0.23f, 0.0f, 0.0f}, {0.23f, 0.22f, 0.18f});
  }
}

// Cross arches from column to pilaster and a coffered ceiling between them.
void add_ceiling(SceneBuilder& b, const Palette& p) {
  const float middle = 0.5f * (kWall + 0.14f - 0.21f);
  const float span = -kWall - 0.14f - 0.21f;
  b.use(p.plaster);
  for (int i = 0; i <= kBays; ++i) {
    b.world_from_shape =
        turned(translation({-kEnd + kBay * static_cast<float>(i), 0, middle}), 90.0f);
    b.arch({-0.5f * span, kSpring}, {0.5f * span, kEaves - 0.02f}, 0.5f * span - 0.02f, 0.3f, 28);
  }
  b.world_from_shape = glm::mat4(1.0f);
  b.use(p.ceiling);
  b.quad({-kEnd, kEaves - 0.02f, kWall}, {kEnd, kEaves - 0.02f, kWall}, {kEnd, kEaves - 0.02f, 0},
         {-kEnd, kEaves - 0.02f, 0});
  b.use(p.wood);
  for (int i = 0; i < kBays * 4; ++i) {
    const float x = -kEnd + 0.25f * kBay * (static_cast<float>(i) + 0.5f);
    b.box({x - 0.05f, kEaves - 0.18f, kWall}, {x + 0.05f, kEaves - 0.02f, -0.2f});
  }
  for (int i = 1; i < 5; ++i) {
    const float z = kWall + 0.6f * static_cast<float>(i);
    b.box({-kEnd, kEaves - 0.12f, z - 0.03f}, {kEnd, kEaves - 0.02f, z + 0.03f});
  }
}

// A balustrade between two columns.
void add_balustrade(SceneBuilder& b, const Palette& p, int bay) {
  const float left = -kEnd + kBay * static_cast<float>(bay) + 0.25f;
  const float right = left + kBay - 0.5f;
  b.world_from_shape = glm::mat4(1.0f);
  b.use(p.step);
  b.box({left, 0.0f, -0.09f}, {right, 0.1f, 0.09f});
  b.box({left, 0.80f, -0.10f}, {right, 0.90f, 0.10f});
  b.use(p.marble);
  const std::vector<glm::vec2> profile = {{0.055f, 0.10f}, {0.055f, 0.14f}, {0.03f, 0.17f},
                                          {0.065f, 0.32f}, {0.055f, 0.42f}, {0.025f, 0.58f},
                                          {0.025f, 0.68f}, {0.045f, 0.72f}, {0.055f, 0.80f}};
  constexpr int kBalusters = 9;
  for (int i = 0; i < kBalusters; ++i) {
    const float x = left + (right - left) * (static_cast<float>(i) + 0.5f) / kBalusters;
    b.world_from_shape = translation({x, 0, 0});
    b.lathe(profile, 10);
  }
}

// A thin railing: bars of a centimetre and a half, the thinnest things here.
void add_railing(SceneBuilder& b, const Palette& p, int bay) {
  const float left = -kEnd + kBay * static_cast<float>(bay) + 0.2f;
  const float right = left + kBay - 0.4f;
  b.world_from_shape = glm::mat4(1.0f);
  b.use(p.bronze);
  for (const float y : {0.12f, 0.95f}) b.bar({left, y, 0}, {right, y, 0}, 0.03f);
  for (int i = 1; i < 16; ++i) {
    const float x = left + (right - left) * static_cast<float>(i) / 16.0f;
    b.bar({x, 0.12f, 0}, {x, 0.95f, 0}, 0.015f);
  }
}

// A lattice of crossed slats that closes a bay.
void add_lattice(SceneBuilder& b, const Palette& p, int bay) {
  const float left = -kEnd + kBay * static_cast<float>(bay) + 0.24f;
  const float width = kBay - 0.48f, height = 2.1f;
  b.world_from_shape = translation({left, 0.08f, 0});
  b.use(p.wood);
  b.bar({0, 0, 0}, {0, height, 0}, 0.05f);
  b.bar({width, 0, 0}, {width, height, 0}, 0.05f);
  b.bar({0, 0, 0}, {width, 0, 0}, 0.05f);
  b.bar({0, height, 0}, {width, height, 0}, 0.05f);
  constexpr float kStep = 0.19f;
  for (float start = -height + kStep; start < width; start += kStep) {
    const float a = std::max(start, 0.0f), c = std::min(start + height, width);
    if (c - a < 0.05f) continue;
    b.bar({a, a - start, 0.012f}, {c, c - start, 0.012f}, 0.02f);
    b.bar({width - a, a - start, -0.012f}, {width - c, c - start, -0.012f}, 0.02f);
  }
}

// Leaves bent outwards on stems from a pot. The spread follows the golden angle.
void add_plant(SceneBuilder& b, const Palette& p, glm::vec3 at, int leaves) {
  b.world_from_shape = translation(at);
  b.use(p.terracotta);
  const std::vector<glm::vec2> pot = {{0.0f, 0.0f},   {0.17f, 0.0f},  {0.24f, 0.32f},
                                      {0.27f, 0.33f}, {0.27f, 0.40f}, {0.23f, 0.40f},
                                      {0.21f, 0.34f}, {0.0f, 0.34f}};
  b.lathe(pot, 24);
  b.use(p.leaf);
  for (int i = 0; i < leaves; ++i) {
    const float angle = 137.508f * static_cast<float>(i);
    const float rise = 0.35f + 0.6f * static_cast<float>(i) / static_cast<float>(leaves);
    const float length = 0.75f - 0.45f * static_cast<float>(i) / static_cast<float>(leaves);
    b.world_from_shape = turned(translation(at + glm::vec3(0, 0.34f, 0)), angle);
    glm::vec3 before(0.02f, 0, 0);
    constexpr int kParts = 5;
    for (int k = 1; k <= kParts; ++k) {
      const float t = static_cast<float>(k) / kParts, u = static_cast<float>(k - 1) / kParts;
      const glm::vec3 now(0.02f + length * t * t, rise * (t * (1.9f - 0.9f * t)), 0);
      const float w0 = 0.075f * std::sin(glm::pi<float>() * (0.12f + 0.88f * u));
      const float w1 =
          k == kParts ? 0.002f : 0.075f * std::sin(glm::pi<float>() * (0.12f + 0.88f * t));
      b.quad(before + glm::vec3(0, 0, w0), now + glm::vec3(0, 0, w1), now - glm::vec3(0, 0, w1),
             before - glm::vec3(0, 0, w0));
      before = now;
    }
  }
}

void add_vase(SceneBuilder& b, const Palette& p, glm::vec3 at) {
  b.world_from_shape = translation(at);
  b.use(p.step);
  b.box({-0.22f, 0.0f, -0.22f}, {0.22f, 0.7f, 0.22f});
  b.box({-0.26f, 0.7f, -0.26f}, {0.26f, 0.76f, 0.26f});
  b.use(p.ceramic);
  const std::vector<glm::vec2> vase = {
      {0.0f, 0.76f},   {0.11f, 0.76f}, {0.12f, 0.79f}, {0.18f, 0.90f},  {0.22f, 1.02f},
      {0.21f, 1.14f},  {0.15f, 1.25f}, {0.09f, 1.32f}, {0.085f, 1.38f}, {0.13f, 1.44f},
      {0.115f, 1.44f}, {0.07f, 1.38f}, {0.07f, 1.30f}, {0.0f, 1.20f}};
  b.lathe(vase, 36);
}

// Benches, lamps and what stands in the niches.
void add_furniture(SceneBuilder& b, const Palette& p) {
  for (const int bay : {1, 4, 6}) {
    const float x = -kEnd + kBay * (static_cast<float>(bay) + 0.5f);
    b.world_from_shape = translation({x, 0, kWall + 0.32f});
    b.use(p.wood);
    b.box({-0.6f, 0.40f, -0.18f}, {0.6f, 0.46f, 0.18f});
    for (const float side : {-0.5f, 0.5f})
      b.box({side - 0.04f, 0.0f, -0.15f}, {side + 0.04f, 0.40f, 0.15f});
  }
  b.use(p.gilt);
  for (int bay = 0; bay < kBays; ++bay) {
    const float x = -kEnd + kBay * (static_cast<float>(bay) + 0.5f);
    b.world_from_shape = glm::mat4(1.0f);
    b.bar({x, 3.25f, -1.5f}, {x, kEaves - 0.1f, -1.5f}, 0.012f);
    b.sphere({x, 3.14f, -1.5f}, 0.12f, 12, 20);
  }
  for (const int bay : {0, 2, 3, 5, 7}) {
    const float x = -kEnd + kBay * (static_cast<float>(bay) + 0.5f);
    b.world_from_shape = glm::mat4(1.0f);
    b.use(bay % 2 ? p.ceramic : p.terracotta);
    b.sphere({x, 0.55f + 0.2f, kWall - 0.17f}, 0.2f, 16, 24);
  }
}

}  // namespace

Scene builtin_scene() {
  SceneBuilder b;
  const Palette p = add_palette(b);
  add_floor(b, p);
  for (int i = 0; i <= kBays; ++i) add_column(b, p, -kEnd + kBay * static_cast<float>(i));
  add_arcade(b, p);
  add_back_wall(b, p);
  add_ceiling(b, p);
  for (const int bay : {2, 5}) add_balustrade(b, p, bay);
  for (const int bay : {1, 6}) add_railing(b, p, bay);
  add_lattice(b, p, 4);
  add_plant(b, p, {-4.3f, 0, -0.75f}, 26);
  add_plant(b, p, {1.2f, 0, -2.45f}, 26);
  add_plant(b, p, {4.6f, 0, -0.7f}, 26);
  add_vase(b, p, {-2.2f, 0, kWall + 0.55f});
  add_vase(b, p, {2.2f, -0.51f, 2.0f});
  add_furniture(b, p);
  Scene scene = b.finish("builtin");
  scene.suggested_radius = 0.5f;
  scene.cameras = {
      scene_camera("arcade", {-7.4f, 1.55f, -1.9f}, {0.0f, 1.35f, -1.2f}, 60.0f, 100.0f),
      scene_camera("court", {-5.2f, 1.5f, 6.2f}, {0.4f, 1.3f, -1.0f}, 50.0f, 100.0f),
      scene_camera("plant", {-5.6f, 1.1f, -1.9f}, {-4.2f, 0.65f, -0.7f}, 55.0f, 100.0f)};
  return scene;
}

}  // namespace alcove::sample
