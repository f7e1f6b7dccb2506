// Tests files as public model sites export them, drawn without options. The image must show the
// model with occlusion, whatever its unit, axes and surroundings are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model_maker.h"

namespace alcove::sample {
namespace {

// The standing parts of a small house, 8 x 5 x 6.
Triangles house(float unit) {
  Triangles out;
  out.add_box(unit * glm::vec3(-4, 0, -3), unit * glm::vec3(4, 3, 3));
  out.add_box(unit * glm::vec3(-4.5f, 3, -3.5f), unit * glm::vec3(4.5f, 3.3f, 3.5f));
  out.add_box(unit * glm::vec3(-1, 0, 3), unit * glm::vec3(1, 0.3f, 5));
  out.add_box(unit * glm::vec3(2, 3.3f, -1), unit * glm::vec3(3, 5, 0));
  for (const float x : {-1.0f, 0.8f}) {
    out.add_box(unit * glm::vec3(x, 0.3f, 4.6f), unit * glm::vec3(x + 0.2f, 2.6f, 4.8f));
  }
  out.add_box(unit * glm::vec3(-1.3f, 2.6f, 3), unit * glm::vec3(1.3f, 2.8f, 5));
  return out;
}

Triangles flat(float half, float height = 0.0f) {
  Triangles out;
  out.add_quad({-half, height, -half}, {-half, height, half}, {half, height, half},
               {half, height, -half});
  return out;
}

// A body of lathes, 1.8 high.
Triangles character() {
  Triangles out;
  out.add_lathe({0, 0.8f, 0}, 1.5f, {0.0f, 0.3f, 0.26f, 0.36f, 0.15f, 0.0f});
  out.add_lathe({0, 1.5f, 0}, 1.8f, {0.0f, 0.14f, 0.18f, 0.15f, 0.0f});
  for (const float x : {-0.15f, 0.15f}) {
    out.add_lathe({x, 0, 0}, 0.85f, {0.0f, 0.12f, 0.1f, 0.15f, 0.0f});
    out.add_lathe({2.7f * x, 0.75f, 0}, 1.45f, {0.0f, 0.08f, 0.09f, 0.1f, 0.0f});
  }
  return out;
}

Triangles city(float spacing) {
  Triangles out;
  std::minstd_rand dice(5);
  for (int i = 0; i < 144; ++i) {
    const glm::vec3 at(spacing * static_cast<float>(i % 12 - 6), 0,
                       spacing * static_cast<float>(i / 12 - 6));
    const float height = spacing * (0.4f + 2.0f * static_cast<float>(dice() % 100) / 100.0f);
    out.add_box(at, at + glm::vec3(0.7f * spacing, height, 0.7f * spacing));
  }
  return out;
}

Triangles screw(float unit) {
  Triangles out;
  std::vector<float> shaft(2, 0.0f);
  for (int i = 0; i < 30; ++i) shaft.push_back(i % 2 == 0 ? 2.0f * unit : 1.6f * unit);
  shaft.push_back(0.0f);
  out.add_lathe({0, 0, 0}, 30.0f * unit, shaft);
  out.add_lathe({0, 30.0f * unit, 0}, 34.0f * unit,
                {0.0f, 4.0f * unit, 4.0f * unit, 4.0f * unit, 0.0f});
  return out;
}

struct Newcomer {
  const char* name;
  void (*make)(ModelMaker&);
  float size;  // of the model without its surroundings, in units of the file
};
std::ostream& operator<<(std::ostream& out, const Newcomer& file) { return out << file.name; }

const Newcomer kFiles[] = {
    {"HouseInCentimetres", [](ModelMaker& m) { m.add(house(100.0f)); }, 1000.0f},
    {"HouseInMillimetresUnderAScaledNode",
     [](ModelMaker& m) {
       m.node({{"mesh", m.mesh(house(1000.0f))}, {"scale", {0.001f, 0.001f, 0.001f}}});
     },
     10.0f},
    {"ZUpTurnedByARootNode",
     [](ModelMaker& m) {
       Triangles turned = house(1.0f);
       for (glm::vec3& p : turned.positions) p = {p.x, -p.z, p.y};
       const float h = std::sqrt(0.5f);
       const int child = m.node({{"mesh", m.mesh(turned)}}, false);
       m.node({{"children", {child}}, {"rotation", {-h, 0, 0, h}}});
     },
     10.0f},
    {"HouseOnAHugeGroundPlane",
     [](ModelMaker& m) {
       m.add(house(1.0f));
       m.add(flat(2000.0f));
     },
     10.0f},
    {"CharacterInASkyDome",
     [](ModelMaker& m) {
       m.add(character());
       m.add(flat(2.0f));
       Triangles dome;
       dome.add_lathe({0, -500, 0}, 500, {0.0f, 300, 430, 490, 500, 490, 430, 300, 0.0f}, true);
       m.add(dome, {{"doubleSided", true}});
     },
     2.0f},
    {"CityBlockOfAKilometre",
     [](ModelMaker& m) {
       m.add(city(80.0f));
       m.add(flat(600.0f));
     },
     1000.0f},
    {"SingleScrewInMetres", [](ModelMaker& m) { m.add(screw(0.001f)); }, 0.034f},
    {"RoomSeenFromInside",
     [](ModelMaker& m) {
       Triangles walls;
       walls.add_box({-3, 0, -4}, {3, 2.6f, 4}, true);
       m.add(walls);
       Triangles furniture;
       furniture.add_box({-1, 0, -2}, {1, 0.8f, -1});
       furniture.add_box({-2.8f, 0, 1}, {-2.2f, 2, 3});
       m.add(furniture);
     },
     8.0f},
    {"ScanFarFromTheOriginWithStraySlivers",
     [](ModelMaker& m) {
       Triangles scan = house(1.0f);
       for (glm::vec3& p : scan.positions) p += glm::vec3(350.0f, 20.0f, -800.0f);
       for (const float x : {-9000.0f, 7000.0f}) {
         const auto first = static_cast<uint32_t>(scan.positions.size());
         scan.positions.insert(scan.positions.end(), {{x, 0, 0}, {x, 0.01f, 0}, {x, 0, 0.01f}});
         scan.indices.insert(scan.indices.end(), {first, first + 1, first + 2});
       }
       m.add(scan);
     },
     10.0f},
    {"MapInProjectedCoordinates",
     [](ModelMaker& m) {
       m.node({{"mesh", m.mesh(city(40.0f))}, {"translation", {691000.0, 120.0, -5335000.0}}});
     },
     500.0f},
    {"MirroredHalvesOfADesk",
     [](ModelMaker& m) {
       Triangles half;
       half.add_box({0, 0.7f, -0.4f}, {0.8f, 0.75f, 0.4f});
       half.add_box({0.5f, 0, -0.35f}, {0.75f, 0.7f, 0.35f});
       half.add_box({0, 0.75f, -0.1f}, {0.25f, 1.1f, 0.0f});
       const int mesh = m.mesh(half);
       m.node({{"mesh", mesh}});
       m.node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
     },
     1.6f},
};

class FirstPicture : public testing::TestWithParam<Newcomer> {};

TEST_P(FirstPicture, ImageOfAModelFileWithoutOptionsShowsTheModelWithOcclusion) {
  const Newcomer& file = GetParam();
  const TemporaryFolder folder;
  ModelMaker maker;
  file.make(maker);
  const auto drawn = draw_file(maker.write(folder, file.name));
  ASSERT_TRUE(drawn);
  const Shares shares = shares_of(*drawn);
  RecordProperty("sky", std::to_string(shares.sky));
  RecordProperty("occluded", std::to_string(shares.occluded));
  EXPECT_LT(shares.sky, 0.96);  // 0.955 for the screw, which is tall; at most 0.852 for others
  EXPECT_GT(shares.occluded, 0.003);  // 0.0054 for the character, whose dome has no occlusion
  EXPECT_LT(shares.least, 0.9);
  EXPECT_LT(shares.occluded, 0.9);
  EXPECT_GT(drawn->settings.radius, file.size / 100.0f);
  EXPECT_LT(drawn->settings.radius, file.size / 5.0f);
  const Camera& camera = drawn->camera;
  const float distance = glm::distance(camera.eye_ws, camera.target_ws);
  EXPECT_LT(distance, 5.0f * file.size);
  EXPECT_GT(camera.near_plane, file.size / 1e4f);
  EXPECT_LT(camera.near_plane, distance);
  EXPECT_GT(camera.far_plane, distance);
  // The environment variable ALCOVE_PICTURES names a folder for copies of the pictures.
  if (const char* pictures = std::getenv("ALCOVE_PICTURES")) {
    const std::filesystem::path into = std::filesystem::path(pictures) / file.name;
    std::filesystem::create_directories(into);
    EXPECT_TRUE(write_images(*drawn, into));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, FirstPicture, testing::ValuesIn(kFiles),
                         [](const auto& file) { return std::string(file.param.name); });

}  // namespace
}  // namespace alcove::sample
