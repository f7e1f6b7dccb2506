// Tests files as public model sites export them, drawn without options. The image must show the
// model with occlusion, whatever its unit, axes and surroundings are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <random>

#include "cli/choose_camera.h"
#include "model_maker.h"
#include "scene/framing.h"

namespace alcove::sample {
namespace {

// The standing parts of a small house, 8 x 5 x 6.
Triangles house(float unit) {
  Triangles out;
  out.add_box(unit * glm::vec3(-4, 0, -3), unit * glm::vec3(4, 3, 3));
  out.add_box(unit * glm::vec3(-4.5f, 3, -3.5f), unit * glm::vec3(4.5f, 3.3f, 3.5f));
  out.add_box(unit * glm::vec3(-1, 0, 3), unit * glm::vec3(1, 0.3f, 5));
  out.add_box(unit * glm::vec3(2, 3.3f, -1), unit * glm::vec3(3, 5, 0));
  for (const float x : {-1.0f, 0.8f})
    out.add_box(unit * glm::vec3(x, 0.3f, 4.6f), unit * glm::vec3(x + 0.2f, 2.6f, 4.8f));
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

Triangles terrain(float half, float relief) {
  Triangles out;
  constexpr int kCells = 48;
  const auto point = [&](int x, int z) {
    const float u = static_cast<float>(x) / kCells, v = static_cast<float>(z) / kCells;
    return glm::vec3((2.0f * u - 1.0f) * half,
                     relief * (std::sin(9.0f * u) * std::cos(7.0f * v) + std::sin(23.0f * u * v)),
                     (2.0f * v - 1.0f) * half);
  };
  for (int z = 0; z < kCells; ++z)
    for (int x = 0; x < kCells; ++x)
      out.add_quad(point(x, z), point(x, z + 1), point(x + 1, z + 1), point(x + 1, z));
  return out;
}

Triangles moved(Triangles triangles, const glm::vec3& by) {
  for (glm::vec3& p : triangles.positions) p += by;
  return triangles;
}

Triangles joined(Triangles a, const Triangles& b) {
  const auto first = static_cast<uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const uint32_t i : b.indices) a.indices.push_back(first + i);
  return a;
}

Triangles ball(const glm::vec3& centre, float radius, bool inward = false) {
  Triangles out;
  std::vector<float> radii;
  for (int i = 0; i <= 12; ++i) {
    const float height = static_cast<float>(i) / 6.0f - 1.0f;
    radii.push_back(radius * std::sqrt(std::max(1.0f - height * height, 0.0f)));
  }
  out.add_lathe(centre - glm::vec3(0, radius, 0), centre.y + radius, radii, inward);
  return out;
}

// The upper half of a ball.
Triangles hemisphere(float radius) {
  Triangles out;
  std::vector<float> radii;
  for (int i = 0; i <= 6; ++i) {
    const float height = static_cast<float>(i) / 6.0f;
    radii.push_back(radius * std::sqrt(std::max(1.0f - height * height, 0.0f)));
  }
  out.add_lathe({0, 0, 0}, radius, radii, true);
  return out;
}

Triangles sliver(float x) {
  Triangles out;
  out.positions = {{x, 0, 0}, {x, 0.01f, 0}, {x, 0, 0.01f}};
  out.indices = {0, 1, 2};
  return out;
}

Triangles furniture() {
  Triangles out;
  out.add_box({-1, 0, -2}, {1, 0.8f, -1});
  out.add_box({-2.8f, 0, 1}, {-2.2f, 2, 3});
  return out;
}

// Floor and walls of a room that is open above, as slabs.
std::vector<Triangles> gallery() {
  std::vector<Triangles> out(5);
  out[0].add_box({-10, -0.1f, -15}, {10, 0, 15});
  out[1].add_box({-10, 0, -15.1f}, {10, 5, -15});
  out[2].add_box({-10.1f, 0, -15}, {-10, 5, 15});
  out[3].add_box({10, 0, -15}, {10.1f, 5, 15});
  out[4].add_box({-10, 0, 15}, {10, 5, 15.1f});
  return out;
}

const nlohmann::json kDoubleSided = {{"doubleSided", true}};

// Makes a model of these meshes; those of `double_sided` have a double-sided material.
auto model(std::vector<Triangles> meshes, std::vector<Triangles> double_sided = {}) {
  return [=](ModelMaker& maker) {
    for (const Triangles& mesh : meshes) maker.add(mesh);
    for (const Triangles& mesh : double_sided) maker.add(mesh, kDoubleSided);
  };
}

std::vector<Triangles> gallery_with_ball() {
  std::vector<Triangles> out = gallery();
  out.push_back(ball({0, 0.3f, 0}, 0.3f));
  return out;
}

Triangles room() {
  Triangles out;
  out.add_box({-3, 0, -4}, {3, 2.6f, 4}, true);
  return out;
}

Triangles cube_map() {
  Triangles out;
  out.add_box(glm::vec3(-50), glm::vec3(50), true);
  return out;
}

std::vector<Triangles> faces_of_cube_map() {
  const Triangles box = cube_map();
  std::vector<Triangles> out(6);
  for (size_t face = 0; face < 6; ++face) {
    const auto first = box.positions.begin() + static_cast<ptrdiff_t>(4 * face);
    out[face].positions.assign(first, first + 4);
    out[face].indices = {0, 1, 2, 0, 2, 3};
  }
  return out;
}

Triangles flat_backdrop() {
  Triangles out;
  out.add_quad({-8, -0.5f, -1.5f}, {8, -0.5f, -1.5f}, {8, 7, -1.5f}, {-8, 7, -1.5f});
  return out;
}

Triangles curved_backdrop() {
  Triangles out;
  float y = 0.0f, z = 5.0f;
  for (const glm::vec2 next : {glm::vec2(0, -1), {0.2f, -2}, {1, -2.8f}, {2, -3}, {7, -3}}) {
    out.add_quad({-6, y, z}, {6, y, z}, {6, next.x, next.y}, {-6, next.x, next.y});
    y = next.x;
    z = next.y;
  }
  return out;
}

std::vector<Triangles> solar_system() {
  std::vector<Triangles> out = {ball({0, 0, 0}, 10.0f)};
  float distance = 25.0f;
  for (const float radius : {0.2f, 0.4f, 0.4f, 0.3f, 1.5f, 1.2f, 0.8f, 0.8f}) {
    out.push_back(ball({distance, 0, 0.3f * distance}, radius));
    distance *= 1.6f;
  }
  return out;
}

Triangles ground_slab() {
  Triangles out;
  out.add_box({-500, -0.1f, -500}, {500, 0, 500});
  return out;
}

Triangles table() {
  Triangles out;
  out.add_box({-0.8f, 0.7f, -0.4f}, {0.8f, 0.75f, 0.4f});
  for (const float x : {-0.75f, 0.7f})
    for (const float z : {-0.38f, 0.33f}) out.add_box({x, 0, z}, {x + 0.05f, 0.7f, z + 0.05f});
  return out;
}

Triangles half_of_desk() {
  Triangles out;
  out.add_box({0, 0.7f, -0.4f}, {0.8f, 0.75f, 0.4f});
  out.add_box({0.5f, 0, -0.35f}, {0.75f, 0.7f, 0.35f});
  out.add_box({0, 0.75f, -0.1f}, {0.25f, 1.1f, 0.0f});
  return out;
}

Triangles house_among_strays() {
  Triangles out = house(1.0f);
  std::minstd_rand dice(3);
  for (int i = 0; i < 500; ++i) {
    const auto coordinate = [&] { return static_cast<float>(dice() % 20000) - 10000.0f; };
    out = joined(out, moved(sliver(0), {coordinate(), coordinate(), coordinate()}));
  }
  return out;
}

struct Newcomer {
  const char* name;
  std::function<void(ModelMaker&)> make;
  // The size of the model without its surroundings, in units of the file: the diagonal of its box.
  float size;
  bool drawn = false;  // also drawn on the device
};
std::ostream& operator<<(std::ostream& out, const Newcomer& file) { return out << file.name; }

constexpr float kHouse = 13.35f, kCharacter = 2.1f, kGallery = 36.5f, kRoom = 10.3f;  // sizes
constexpr bool kDrawn = true;
const nlohmann::json kProjected = {691000.0, 120.0, -5335000.0};  // coordinates of a map

const Newcomer kFiles[] = {
    {"HouseInCentimetres", model({house(100.0f)}), 100.0f * kHouse, kDrawn},
    {"HouseInMillimetresUnderAScaledNode",
     [](ModelMaker& m) {
       m.node({{"mesh", m.mesh(house(1000.0f))}, {"scale", {0.001f, 0.001f, 0.001f}}});
     },
     kHouse, kDrawn},
    {"ZUpTurnedByARootNode",
     [](ModelMaker& m) {
       Triangles turned = house(1.0f);
       for (glm::vec3& p : turned.positions) p = {p.x, -p.z, p.y};
       const float h = std::sqrt(0.5f);
       const int child = m.node({{"mesh", m.mesh(turned)}}, false);
       m.node({{"children", {child}}, {"rotation", {-h, 0, 0, h}}});
     },
     kHouse, kDrawn},
    {"HouseOnAHugeGroundPlane", model({house(1), flat(2000)}), kHouse, kDrawn},
    {"CharacterInASkyDome", model({character()}, {ball({0, 0, 0}, 500, true)}), kCharacter, kDrawn},
    {"CityBlockOfAKilometre", model({city(80), flat(600)}), 1700, kDrawn},
    {"SingleScrewInMetres", model({screw(0.001f)}), 0.036f, kDrawn},
    {"RoomSeenFromInside", model({room(), furniture()}), kRoom, kDrawn},
    {"ScanFarFromTheOriginWithStraySlivers",
     model({joined(joined(moved(house(1), {350, 20, -800}), sliver(-9000)), sliver(7000))}), kHouse,
     kDrawn},
    {"MapInProjectedCoordinates",
     [](ModelMaker& m) {
       m.node({{"mesh", m.mesh(city(40))}, {"translation", kProjected}});
     },
     680, kDrawn},
    {"MirroredHalvesOfADesk",
     [](ModelMaker& m) {
       const int mesh = m.mesh(half_of_desk());
       m.node({{"mesh", mesh}});
       m.node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
     },
     2.1f, kDrawn},
    {"ScrewInMillimetres", model({screw(1)}), 36},
    {"CityInCentimetres", model({city(8000)}), 136000},
    {"CharacterInACubeMapBox", model({cube_map(), character()}), kCharacter},
    {"CharacterInACubeMapOfSixMeshes", model({character()}, faces_of_cube_map()), kCharacter},
    {"CharacterBeforeAFlatBackdrop", model({flat_backdrop(), character()}), kCharacter},
    {"CharacterBeforeACurvedBackdrop", model({curved_backdrop(), character()}), kCharacter},
    {"TerrainInProjectedCoordinates",
     [](ModelMaker& m) {
       m.node({{"mesh", m.mesh(terrain(500, 60))}, {"translation", kProjected}});
     },
     1430},
    {"Gallery", model(gallery_with_ball()), kGallery},
    {"TwoClustersFiveKilometresApart", model({house(1), moved(house(1), {5000, 0, 0})}), kHouse},
    {"SolarSystem", model(solar_system()), 34.6f},
    {"HouseJoinedWithItsGround", model({joined(ground_slab(), house(1))}), kHouse},
    {"HouseInALowPolygonSkyWithGround", model({house(1), flat(300)}, {hemisphere(300)}), kHouse},
    {"HouseInAHemisphereJoinedWithItsGround",
     model({house(1)}, {joined(hemisphere(150), flat(150))}), kHouse},
    {"HouseInASmallSkyDome", model({house(1)}, {ball({0, 0, 0}, 25, true)}), kHouse},
    {"HouseInASkyDomeTurnedOutwards", model({house(1)}, {ball({0, 0, 0}, 200)}), kHouse},
    {"ClosedRoomOfDoubleSidedWalls", model({furniture()}, {room()}), kRoom},
    {"TableWithACup", model({table(), ball({0.2f, 0.8f, 0}, 0.05f)}), 1.95f},
    {"StrayAtTenMetres", model({house(1), sliver(10)}), kHouse},
    {"StrayAtTwentyMetres", model({house(1), sliver(20)}), kHouse},
    {"StrayAtFortyMetres", model({house(1), sliver(40)}), kHouse},
    {"StrayAtAKilometre", model({house(1), sliver(1000)}), kHouse},
    {"StraysAllAroundAtTenKilometres", model({house_among_strays()}), kHouse},
};

// The share of the rows of the image that show the subject of the scene.
double height_of_subject(const Scene& scene, const Camera& camera, double aspect) {
  const Bounds& bounds = scene.subject.bounds_ws;
  const DepthPicture with = draw_depth(scene, camera, aspect);
  std::vector<char> rows(with.depth.height, 0);
  const CameraMatrices matrices = camera_matrices(camera, with.depth.width, with.depth.height);
  const float margin = 0.02f * static_cast<float>(diagonal(bounds));
  for (uint32_t y = 0; y < with.depth.height; ++y) {
    for (uint32_t x = 0; x < with.depth.width; ++x) {
      const glm::vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Ray ray = camera_ray(matrices, false, pixel, with.depth.width, with.depth.height);
      const float along = glm::dot(ray.direction_ws, -glm::vec3(matrices.world_from_view[2]));
      const glm::vec3 at = ray.origin_ws + ray.direction_ws * (with.depth.at(x, y) / along);
      rows[y] |= contains({bounds.low - margin, bounds.high + margin}, at);
    }
  }
  return static_cast<double>(std::ranges::count(rows, 1)) / with.depth.height;
}

// Whether the box of the subject lies within the image.
bool is_whole_subject_in_view(const Scene& scene, const Camera& camera, double aspect) {
  const auto width = static_cast<uint32_t>(100.0 * aspect);
  const CameraMatrices matrices = camera_matrices(camera, width, 100);
  return std::ranges::all_of(corners_of(scene.subject.bounds_ws), [&](const glm::vec3& corner) {
    const glm::vec4 clip = matrices.clip_from_world * glm::vec4(corner, 1.0f);
    return clip.w > 0.0f && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
  });
}

class FirstPicture : public testing::TestWithParam<Newcomer> {};

TEST_P(FirstPicture, SubjectFillsTheImageAndRadiusIsATwentiethOfItsSize) {
  const Newcomer& file = GetParam();
  ModelMaker maker;
  file.make(maker);
  const Scene scene = parsed(maker.gltf.glb());
  ViewOptions view;
  const auto camera = choose_camera(view, scene);
  ASSERT_TRUE(camera);
  const double aspect = static_cast<double>(view.width) / view.height;
  const RadiusChoice choice = radius_for_view(scene, *camera, aspect);
  const double height = height_of_subject(scene, *camera, aspect);
  RecordProperty("radius", std::to_string(choice.radius));
  RecordProperty("height", std::to_string(height));
  EXPECT_GT(choice.radius, 0.05f * file.size / 1.5f) << choice.reason;
  EXPECT_LT(choice.radius, 0.05f * file.size * 1.5f) << choice.reason;
  EXPECT_GT(height, 0.25);
  // The eye is inside of a closed room.
  EXPECT_TRUE(contains(scene.subject.bounds_ws, camera->eye_ws) ||
              is_whole_subject_in_view(scene, *camera, aspect));
  EXPECT_NEAR(diagonal(scene.subject.bounds_ws), file.size, 0.1 * file.size);
}

INSTANTIATE_TEST_SUITE_P(Files, FirstPicture, testing::ValuesIn(kFiles),
                         [](const auto& file) { return std::string(file.param.name); });

// A view that the user types, and the extent of what it shows.
struct TypedView {
  const char* name;
  std::function<void(ModelMaker&)> make;
  glm::dvec3 eye, target;
  float extent;
};
std::ostream& operator<<(std::ostream& out, const TypedView& view) { return out << view.name; }

const TypedView kTypedViews[] = {
    {"HouseWithAStrayTriangleBehindIt",
     model({house(1), sliver(40)}),
     {9, 6, 13},
     {0, 2, 0},
     kHouse},
    {"GalleryFromItsEntrance", model(gallery_with_ball()), {0, 1.6, 14}, {0, 1, -15}, kGallery},
    {"BallInAGallery", model(gallery_with_ball()), {0, 0.6, 1.2}, {0, 0.2, 0}, 6},
    {"HouseOnAHugeGroundPlaneFromAFar", model({house(1), flat(2000)}), {0, 12, 40}, {}, kHouse},
};

class TypedViews : public testing::TestWithParam<TypedView> {};

TEST_P(TypedViews, RadiusIsATwentiethOfTheExtentOfTheSurfacesInView) {
  ModelMaker maker;
  GetParam().make(maker);
  const Scene scene = parsed(maker.gltf.glb());
  ViewOptions view;
  view.eye = GetParam().eye;
  view.target = GetParam().target;
  const auto camera = choose_camera(view, scene);
  ASSERT_TRUE(camera);
  const RadiusChoice choice =
      radius_for_view(scene, *camera, static_cast<double>(view.width) / view.height);
  EXPECT_GT(choice.radius, 0.05f * GetParam().extent / 1.5f) << choice.reason;
  EXPECT_LT(choice.radius, 0.05f * GetParam().extent * 1.5f) << choice.reason;
}

INSTANTIATE_TEST_SUITE_P(Views, TypedViews, testing::ValuesIn(kTypedViews),
                         [](const auto& view) { return std::string(view.param.name); });

std::vector<Newcomer> drawn_files() {
  std::vector<Newcomer> out;
  std::ranges::copy_if(kFiles, std::back_inserter(out), &Newcomer::drawn);
  return out;
}

class DrawnFirstPicture : public FirstPicture {};

TEST_P(DrawnFirstPicture, ImageOfAModelFileWithoutOptionsShowsTheModelWithOcclusion) {
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
  // 0.00056 for the character, whose dome has no occlusion; at least 0.003 for others.
  EXPECT_GT(shares.occluded, 0.0004);
  EXPECT_LT(shares.least, 0.9);
  EXPECT_LT(shares.occluded, 0.9);
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

INSTANTIATE_TEST_SUITE_P(Files, DrawnFirstPicture, testing::ValuesIn(drawn_files()),
                         [](const auto& file) { return std::string(file.param.name); });

}  // namespace
}  // namespace alcove::sample
