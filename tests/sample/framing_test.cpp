// Tests the first picture of files as people export them.
#include "scene/framing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cli/choose_camera.h"
#include "model_maker.h"

namespace alcove::sample {
namespace {

constexpr double kAspect = 16.0 / 9.0;

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

Triangles box(const glm::vec3& low, const glm::vec3& high, bool inward = false) {
  Triangles out;
  out.add_box(low, high, inward);
  return out;
}

Triangles quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  Triangles out;
  out.add_quad(a, b, c, d);
  return out;
}

// A small house, 9 x 5 x 8.5.
Triangles house(float unit = 1.0f) {
  Triangles out = box({-4, 0, -3}, {4, 3, 3});
  out.add_box({-4.5f, 3, -3.5f}, {4.5f, 3.3f, 3.5f});
  out.add_box({-1, 0, 3}, {1, 0.3f, 5});
  out.add_box({2, 3.3f, -1}, {3, 5, 0});
  for (glm::vec3& p : out.positions) p *= unit;
  return out;
}

Triangles flat(float half) {
  return quad({-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half});
}

// A ball, or its half above y = 0.
Triangles ball(float radius, bool inward, float bottom = -1.0f) {
  Triangles out;
  std::vector<float> radii;
  for (int i = 0; i <= 12; ++i) {
    const float height = bottom + (1.0f - bottom) * static_cast<float>(i) / 12.0f;
    radii.push_back(radius * std::sqrt(std::max(1.0f - height * height, 0.0f)));
  }
  out.add_lathe({0, bottom * radius, 0}, radius, radii, inward);
  return out;
}

// A wall around the origin, which faces it.
Triangles tube(float radius, float height) {
  Triangles out;
  out.add_lathe({0, 0, 0}, height, {radius, radius}, true);
  return out;
}

std::vector<Triangles> tiles_under(const Triangles& subject) {
  std::vector<Triangles> out{subject};
  for (const float x : {-40.0f, 0.0f, 40.0f})
    for (const float z : {-20.0f, 20.0f}) out.push_back(moved(flat(20), {x, 0, z}));
  return out;
}

Triangles sliver(const glm::vec3& at) {
  return moved({{{0, 0, 0}, {0, 0.01f, 0}, {0, 0, 0.01f}}, {0, 1, 2}}, at);
}

Triangles strays() {
  Triangles out;
  std::minstd_rand dice(3);
  const auto coordinate = [&] { return static_cast<float>(dice() % 20000) - 10000.0f; };
  for (int i = 0; i < 500; ++i)
    out = joined(out, sliver({coordinate(), coordinate(), coordinate()}));
  return out;
}

const nlohmann::json kDoubleSided = {{"doubleSided", true}};

// Single- and double-sided meshes at one place of the file.
Scene scene_of(const std::vector<Triangles>& single, const std::vector<Triangles>& both = {},
               const nlohmann::json& at = {0, 0, 0}) {
  ModelMaker maker;
  for (const Triangles& mesh : single)
    maker.node({{"mesh", maker.mesh(mesh)}, {"translation", at}});
  for (const Triangles& mesh : both)
    maker.node({{"mesh", maker.mesh(mesh, kDoubleSided)}, {"translation", at}});
  return parsed(maker.gltf.glb());
}

Camera first_camera(const Scene& scene) {
  const auto camera = choose_camera(ViewOptions(), ViewFinder(scene));
  EXPECT_TRUE(camera);
  return *camera;
}

struct File {
  const char* name;
  Triangles subject;
  std::vector<Triangles> single, both;  // meshes of single- and of double-sided materials
  const char* left_out = "";
  float eye_within = INFINITY;  // of the origin
  nlohmann::json at = {0, 0, 0};
};

std::vector<File> files() {
  const auto home = house(), far_home = moved(home, {900, 0, 400});
  const auto small = house(1e-5f), large = house(1e6f);
  const auto board = box({0, 0, 0}, {1, 0.03f, 1});
  const auto chip = box({0.4f, 0.03f, 0.4f}, {0.48f, 0.11f, 0.48f});
  const auto phone = box({0, 0, 0}, {0.07f, 0.15f, 0.008f});
  const auto lens = box({0.005f, 0.11f, -0.002f}, {0.035f, 0.14f, 0});
  const auto hull = box({-4, 0, -3}, {4, 3, 3});
  const auto door = quad({0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3});
  const auto cloth = box({-0.6f, 0.3f, -0.01f}, {0.6f, 2.4f, 0.01f});
  const auto pole = box({-0.03f, 0, -0.03f}, {0.03f, 2.6f, 0.03f});
  const auto person = box({-0.4f, 0, -0.2f}, {0.4f, 1.8f, 0.2f});
  const auto wall = quad({1, 0, 0}, {-1, 0, 0}, {-1, 1, 0}, {1, 1, 0});
  const auto mug = joined(ball(1, false), ball(0.9f, true));
  const auto ceiling = moved(flat(5), {0, 3, 0});
  const auto lamp = moved(ball(0.2f, false), {1, 1, 0});
  const auto duck = moved(ball(0.04f, false), {0.2f, 0.06f, 0});
  const auto dome = joined(ball(150, true, 0), flat(150));
  const auto sky_box = box(glm::vec3(-50), glm::vec3(50), true);
  const auto strayed = joined(home, sliver({0, 3, 200}));
  const Triangles needle{{{0, 0, 0}, {0, 1, 0}, {8e4f, 4e4f, 0}}, {0, 1, 2}};
  auto tub = box({-0.85f, 0, -0.4f}, {0.85f, 0.6f, 0.4f});
  tub.indices.erase(tub.indices.begin() + 18, tub.indices.begin() + 24);  // the upper side
  std::vector<File> out{
      {"House", home, {home}},
      {"HouseOf1e-5", small, {small}},
      {"HouseOf1e6", large, {large}},
      {"HouseFarAway", home, {home}, {}, "", INFINITY, {691000.0, 120.0, -5335000.0}},
      {"HouseOnAWideGround", home, {home, flat(2000)}, {}, "ground"},
      {"HouseJoinedWithItsGround", flat(500), {joined(flat(500), home)}},
      {"HouseOnSixTiles", home, tiles_under(home), {}, "ground"},
      {"BodyAroundAHouse", ball(200, false), {home, ball(200, false)}},
      {"SkyThatFacesOut", home, {}, {home, flat(39), ball(40, false)}, "sky or room, ground", 40},
      {"NestedSkies", home, {home, ball(50, true), ball(40, true)}, {}, "sky or room", 50},
      {"NoTop", home, {home, flat(50), tube(50, 25)}, {}, "sky or room, ground", 50},
      {"SkyJoinedWithItsGround", home, {home, dome}, {}, "sky or room", 150},
      {"SkyBox", home, {home, sky_box}, {}, "sky or room", 87},
      {"SmallSky", person, {person, flat(60), ball(12, true, 0)}, {}, "sky or room, ground", 12},
      {"Strayed", home, {strayed, ball(500, true)}, {}, "sky or room, stray triangles (1)", 500},
      {"VertexFarAway", home, {joined(home, needle)}, {}, "stray triangles (1)"},
      {"TwoClusters", far_home, {house(0.9f), far_home}, {}, "stray triangles (48)"},
      {"HouseAmongStrays", home, {joined(home, strays())}, {}, "stray triangles (500)"},
      {"BathtubWithADuck", tub, {}, {tub, duck}},
      {"LampUnderACeiling", joined(flat(5), ceiling), {}, {flat(5), ceiling, lamp}},
      {"HouseWithALampInside", hull, {hull, lamp}},
      {"HouseWithADoor", hull, {}, {hull, door}},
      {"BannerWithARod", joined(cloth, pole), {cloth, pole}},
      {"BoardWithAChip", joined(board, chip), {board, chip}},
      {"PhoneWithALens", joined(phone, lens), {phone, lens}},
      {"Plan", flat(10), {flat(10)}},
      {"WallThatFacesBack", wall, {wall}},
      {"Mug", mug, {mug}},
  };
  for (const float r : {30.0f, 120.0f, 1000.0f})
    for (const auto& sky : {ball(r, true), ball(r, true, 0)})
      for (const float ground : {0.7f, 1.0f, 2.0f})
        out.push_back({"Sky", home, {home, flat(ground * r)}, {sky}, "sky or room, ground", r});
  for (const float x : {30.0f, 60.0f, 200.0f})
    out.push_back({"Sliver", home, {home, sliver({x, 0, 0})}, {}, "stray triangles (1)"});
  return out;
}

TEST(FirstPicture, SubjectFillsTheImageAndRadiusIsATwentiethOfTheWidthOfTheView) {
  for (const File& file : files()) {
    SCOPED_TRACE(file.name);
    Bounds bounds = empty_bounds();
    for (const glm::vec3& p : file.subject.positions) bounds = united(bounds, {p, p});
    const Scene scene = scene_of(file.single, file.both, file.at);
    const ViewFinder finder(scene);
    const std::string left_out = file.left_out;
    EXPECT_EQ(finder.left_out(),
              left_out.empty() ? "" : "The default view is framed without " + left_out + ".");
    const Camera camera = first_camera(scene);
    const CameraMatrices matrices = camera_matrices(camera, 160, 90);
    EXPECT_LT(glm::length(camera.eye_ws), file.eye_within);
    float most = 0.0f;  // 1: the border of the image
    for (glm::vec3 corner : corners_of(bounds)) {
      corner += camera.target_ws - 0.5f * (bounds.low + bounds.high);  // the scene may have moved
      const glm::vec4 clip = matrices.clip_from_world * glm::vec4(corner, 1.0f);
      EXPECT_GT(clip.z, 0.0f);
      most = std::max({most, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    EXPECT_NEAR(most, 0.9f, 0.02f);
    // The width of the view at the target.
    const double width = 2.0 * std::tan(0.5 * camera.fov_y) * kAspect *
                         double(glm::distance(camera.eye_ws, camera.target_ws));
    const RadiusChoice choice = finder.radius(camera, kAspect);
    EXPECT_GT(choice.radius, 0.05 * width / 1.4);
    EXPECT_LT(choice.radius, 0.05 * width * 1.4);
  }
}

TEST(FirstPicture, EyeIsInsideOfARoomWithoutAnOutside) {
  const auto room = box({-3, 0, -4}, {3, 2.6f, 4}, true);
  const auto table = box({-1, 0, -2}, {1, 0.8f, -1});
  auto open = room;  // without the wall at z = 4, as a Cornell box
  open.indices.erase(open.indices.end() - 6, open.indices.end());
  auto court = box({-3, 0, -4}, {3, 9, 4}, true);
  court.indices.erase(court.indices.begin() + 18, court.indices.begin() + 24);  // the upper side
  for (const Scene& scene : {scene_of({room, table}), scene_of({table}, {room}),
                             scene_of({table, open}), scene_of({table, court})}) {
    const Camera camera = first_camera(scene);
    EXPECT_TRUE(contains(scene.bounds_ws, camera.eye_ws));
    EXPECT_THAT(ViewFinder(scene).radius(camera, kAspect).advice,
                testing::HasSubstr(
                    "from inside, because that shows more; to see the outside, draw back faces"));
  }
  // Slabs have an outside.
  const Scene crate = scene_of({joined(room, box({-3.2f, -0.2f, -4.2f}, {3.2f, 2.8f, 4.2f}))});
  EXPECT_FALSE(contains(crate.bounds_ws, first_camera(crate).eye_ws));
}

TEST(Radius, IsATwentiethOfTheWidthOfTheViewAtTheMedianDistanceFromWhateverEye) {
  // A wall of half the image at a distance of 4, and a sky behind it that does not count.
  const Scene scene =
      scene_of({quad({-9, -9, -4}, {0, -9, -4}, {0, 9, -4}, {-9, 9, -4})}, {ball(300, true)});
  Camera camera;
  camera.fov_y = glm::radians(90.0f);
  EXPECT_NEAR(ViewFinder(scene).radius(camera, 2.0).radius, 0.05 * 2.0 * 2.0 * 4.0, 1e-3);
  camera.orthographic = true;
  camera.ortho_height = 3.0f;
  EXPECT_NEAR(ViewFinder(scene).radius(camera, 2.0).radius, 0.05 * 2.0 * 3.0, 1e-5);
}

TEST(FittedPlanes, EncloseTheScene) {
  const Scene scene = scene_of({house(), flat(2000)});
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.eye_ws = {0, 2, 10};
    camera.target_ws = {0, 2, 0};
    camera.orthographic = orthographic;
    camera.ortho_height = 10.0f;
    const Camera fitted = ViewFinder(scene).with_fitted_planes(camera, kAspect);
    EXPECT_LT(fitted.near_plane, 4.9f);
    EXPECT_GT(fitted.near_plane, orthographic ? -INFINITY : 0.001f);
    EXPECT_GT(fitted.far_plane, 2010.0f);
    EXPECT_LT(fitted.far_plane, 4000.0f);
  }
}

TEST(ViewAdvice, NamesARemedyIfTheViewShowsFewSurfaces) {
  const Scene scene = scene_of({quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0})});
  const auto advice = [&](float eye, float target) {
    Camera camera;
    camera.eye_ws = {0, 0, eye};
    camera.target_ws = {0, 0, target};
    camera.far_plane = 1000.0f;
    return ViewFinder(scene).radius(camera, kAspect).advice;
  };
  EXPECT_EQ(advice(20, 0), "");
  EXPECT_EQ(advice(90, 0), "");  // a twentieth of the view
  EXPECT_THAT(advice(400, 0), testing::HasSubstr("hardly any of the view"));
  EXPECT_THAT(advice(20, 40), testing::HasSubstr("nothing but sky"));
  EXPECT_THAT(advice(-20, 0),
              testing::HasSubstr("back faces, which are not drawn: draw them by --both-sides"));
}

TEST(FirstPicture, PlaneThatFacesDownIsSeenFromBelowWithANoteUnlessBothSidesAreDrawn) {
  const Triangles plane = quad({-5, 0, 5}, {-5, 0, -5}, {5, 0, -5}, {5, 0, 5});
  const Scene scene = scene_of({plane}), both = scene_of({}, {plane});
  const Camera camera = ViewFinder(scene).framing_camera(kAspect);
  EXPECT_LT(camera.eye_ws.y, -1.0f);
  EXPECT_THAT(ViewFinder(scene).radius(camera, kAspect).advice, testing::HasSubstr("--both-sides"));
  EXPECT_GT(ViewFinder(both).framing_camera(kAspect).eye_ws.y, 1.0f);
}

TEST(FirstPicture, SceneOfManyTrianglesIsFramedByItsBox) {
  Scene scene = scene_of({ball(0.4f, false)});
  for (int i = 0; i < 200'000; ++i) {
    scene.meshes[0].instances.emplace_back(1.0f);
    scene.meshes[0].instances.back()[3] = {i % 500, 0, i / 500};
  }
  scene.bounds_ws = bounds_of(scene.meshes);
  EXPECT_NEAR(first_camera(scene).target_ws.x, 249.5f, 0.01f);
}

}  // namespace
}  // namespace alcove::sample
