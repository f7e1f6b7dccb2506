// Makes each usual mistake of integration from the first frame on, among correct frames, and after
// a resize. Each must be named by its own sentence alone. Frames without a mistake must not be
// reported.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "gpu_test.h"
#include "mistakes.h"
#include "scene/builtin_scene.h"
#include "scene/load_scene.h"
#include "scene/shapes.h"

namespace alcove::sample {
namespace {

constexpr EngineCourse kQuick{.size = {120, 68}, .frames = 26};

// Leaves that are a pixel or two wide in a small picture and have the normals of their crown.
Scene foliage() {
  SceneBuilder b;
  b.use(b.add_material("leaf", {0.1f, 0.3f, 0.1f}, 1.0f));
  b.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  std::mt19937 random(7);
  const auto draw = [&] { return static_cast<float>(random()) / 2147483648.0f - 1.0f; };
  const auto draw_place = [&](float size) {
    const float x = draw(), y = draw();
    return size * glm::vec3(x, y, draw());
  };
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 at = draw_place(0.8f), u = draw_place(0.03f), v = draw_place(0.03f);
    const glm::vec3 place = at + glm::vec3(0.0f, 1.9f, 0.0f);
    if (glm::length(at) < 0.8f)
      b.smooth_quad({place - u - v, place + u - v, place + u + v, place - u + v}, {at, at, at, at});
  }
  Scene scene = b.finish("foliage");
  scene.suggested_radius = 0.3f;
  scene.cameras = {scene_camera("tree", {2.5f, 1.7f, 2.5f}, {0.0f, 1.5f, 0.0f}, 40.0f, 100.0f)};
  return scene;
}

// One device for all tests.
class Mistakes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_gpu = open_validated();
    ASSERT_TRUE(shared_gpu);
    EngineCourse resized = kQuick;
    resized.resize = true;
    shared_engine = std::make_unique<Engine>(*shared_gpu, builtin());
    small_run = std::make_unique<MistakeRun>(*shared_engine, camera(), kQuick);
    resized_run = std::make_unique<MistakeRun>(*shared_engine, camera(), resized);
  }
  static void TearDownTestSuite() {
    small_run.reset();
    resized_run.reset();
    shared_engine.reset();
    shared_gpu.reset();
  }
  static const Scene& builtin() {
    static const Scene scene = builtin_scene();
    return scene;
  }
  // Looks down at surfaces of many directions.
  static const Camera& camera() {
    return *std::ranges::find(builtin().cameras, "plant", &Camera::name);
  }

  static void expect_each_named(MistakeRun& run, std::uint32_t begin) {
    for (const PlantedMistake& mistake : planted_mistakes()) {
      const auto report = run.draw(mistake, begin);
      ASSERT_TRUE(report) << report.error();
      EXPECT_TRUE(names(*report, mistake))
          << mistake.name << ", from frame " << begin << ": " << *report;
    }
  }

  static void expect_silent(Engine& engine, const Camera& from, const EngineCourse& course,
                            const std::string& name) {
    const auto run = EngineRun::create(engine, from, course);
    ASSERT_TRUE(run) << run.error();
    const auto report = diagnose_correct_frames(**run);
    ASSERT_TRUE(report) << report.error();
    EXPECT_EQ(*report, "") << name << ", camera " << from.name;
  }

  static inline ValidatedGpu shared_gpu;
  static inline std::unique_ptr<Engine> shared_engine;
  static inline std::unique_ptr<MistakeRun> small_run;
  static inline std::unique_ptr<MistakeRun> resized_run;
};

TEST_F(Mistakes, EachMistakeIsNamedIfItIsMadeFromTheFirstFrameOn) {
  expect_each_named(*small_run, 0);
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAmongCorrectFrames) {
  expect_each_named(*small_run, 10);
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAfterAResize) {
  expect_each_named(*resized_run, kQuick.change_at + 1);
}

TEST_F(Mistakes, CorrectFramesOfEachSceneAreNotReported) {
  for (const char* name :
       {"builtin", "terrain", "plane:60", "groove:90", "corner", "sphere", "pit", "step"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene) << scene.error();
    for (std::size_t i = 1; i < scene->meshes.size(); i += 4) scene->meshes[i].moves = true;
    Engine engine(*shared_gpu, *scene);
    EngineCourse course = kQuick;
    course.frames = 16;  // no mistake is judged by more
    course.radius = scene->suggested_radius;
    for (Camera& from : scene->cameras) {
      from.reversed_z = true;
      // One camera has all courses, and the others the first ones.
      std::vector<CorrectCourse> courses = correct_courses(course);
      const bool first = std::string_view(name) == "builtin" && &from == scene->cameras.data();
      if (!first) courses.resize(3);
      for (const CorrectCourse& each : courses) {
        expect_silent(engine, from, each.course, std::string(name) + ", " + each.name);
      }
    }
  }
}

TEST_F(Mistakes, FoliageInSmallPicturesIsNotReported) {
  const Scene scene = foliage();
  Engine engine(*shared_gpu, scene);
  for (const VkExtent2D size : {VkExtent2D{140, 79}, {160, 90}, {180, 101}, {200, 113}}) {
    EngineCourse course{.size = size, .radius = scene.suggested_radius};
    for (const float orbit : {0.0f, 0.01f, 0.05f}) {
      course.orbit = orbit;
      expect_silent(engine, scene.cameras.front(), course, std::to_string(size.width));
    }
  }
}

TEST_F(Mistakes, SentenceLeavesWhenTheSizeNoLongerChanges) {
  const PlantedMistake& changes = *std::ranges::find(
      planted_mistakes(), std::string_view("a size that changes, without largest_width"),
      &PlantedMistake::name);
  for (const std::uint32_t frames : {12u, 48u}) {
    const EngineCourse course{.size = kQuick.size, .frames = frames, .jitter = true};
    auto run = EngineRun::create(*shared_engine, camera(), course);
    ASSERT_TRUE(run) << run.error();
    const auto report = (*run)->draw([&](EngineFrame& frame) {
      if (frame.frame.index < 10) changes.plant(frame);
    });
    ASSERT_TRUE(report) << report.error();
    EXPECT_EQ(names(*report, changes), frames == 12) << *report;
    EXPECT_EQ(report->empty(), frames == 48) << *report;
  }
}

}  // namespace
}  // namespace alcove::sample
