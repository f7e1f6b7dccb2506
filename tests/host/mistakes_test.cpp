// Makes each usual mistake of integration from the first frame on, in the midst of frames that are
// right, and after a resize. Each must be named by its own sentence alone. Frames without a mistake
// must not be reported.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "gpu_test.h"
#include "mistakes.h"
#include "scene/builtin_scene.h"
#include "scene/load_scene.h"

namespace alcove::sample {
namespace {

constexpr EngineCourse kQuick{.size = {120, 68}, .frames = 26, .quick = true};

// One device for all tests.
class Mistakes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    gpu_ = open_validated();
    ASSERT_TRUE(gpu_);
    EngineCourse resized = kQuick;
    resized.resize = true;
    engine_ = std::make_unique<Engine>(*gpu_, builtin());
    whole_ = std::make_unique<MistakeRun>(*engine_, camera(), EngineCourse{});
    run_ = std::make_unique<MistakeRun>(*engine_, camera(), kQuick);
    resized_ = std::make_unique<MistakeRun>(*engine_, camera(), resized);
  }
  static void TearDownTestSuite() {
    whole_.reset();
    run_.reset();
    resized_.reset();
    engine_.reset();
    gpu_.reset();
  }
  static const Scene& builtin() {
    static const Scene scene = builtin_scene();
    return scene;
  }
  // Looks down at surfaces of many directions.
  static const Camera& camera() {
    return *std::ranges::find(builtin().cameras, "plant", &Camera::name);
  }

  static Image<float> expect_named(MistakeRun& run, const PlantedMistake& mistake,
                                   std::uint32_t begin) {
    const auto drawn = run.draw(mistake, begin);
    EXPECT_TRUE(drawn) << drawn.error();
    if (!drawn) return {};
    EXPECT_TRUE(names(drawn->said, mistake))
        << mistake.name << ", from frame " << begin << ": " << drawn->said;
    return drawn->visibility;
  }

  static inline ValidatedGpu gpu_;
  static inline std::unique_ptr<Engine> engine_;
  static inline std::unique_ptr<MistakeRun> whole_;  // with the samples of `medium`
  static inline std::unique_ptr<MistakeRun> run_;
  static inline std::unique_ptr<MistakeRun> resized_;
};

// Also prints the RMSE of the visibility for each mistake.
TEST_F(Mistakes, EachMistakeIsNamedIfItIsMadeFromTheFirstFrameOn) {
  std::array<Image<float>, PlantedMistake::kinds> right;
  for (std::size_t i = 0; i < right.size(); ++i)
    right.at(i) = whole_->draw_right(static_cast<PlantedMistake::Frames>(i)).value().visibility;
  for (const PlantedMistake& mistake : planted_mistakes()) {
    const Image<float> drawn = expect_named(*whole_, mistake, 0);
    if (drawn.empty()) continue;  // the frames were refused
    double squares = 0.0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i)
      squares += std::pow(drawn.pixels[i] - right.at(mistake.frames).pixels[i], 2.0);
    std::cout << std::sqrt(squares / static_cast<double>(drawn.pixels.size())) << "  "
              << mistake.name << "\n";
  }
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAmongRightFrames) {
  for (const PlantedMistake& mistake : planted_mistakes()) expect_named(*run_, mistake, 10);
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAfterAResize) {
  for (const PlantedMistake& mistake : planted_mistakes())
    expect_named(*resized_, mistake, kQuick.change_at + 1);
}

TEST_F(Mistakes, RightFramesOfEachSceneAreNotReported) {
  for (const char* name :
       {"builtin", "terrain", "plane:60", "groove:90", "corner", "sphere", "pit", "step"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene) << scene.error();
    for (std::size_t i = 1; i < scene->meshes.size(); i += 4) scene->meshes[i].moves = true;
    Engine engine(*gpu_, *scene);
    EngineCourse course = kQuick;
    course.frames = 16;  // no mistake is judged by more
    course.radius = scene->suggested_radius;
    for (Camera& from : scene->cameras) {
      from.reversed_z = true;
      // One camera has all courses, and the others the first ones.
      std::vector<RightCourse> courses = right_courses(course);
      const bool first = std::string_view(name) == "builtin" && &from == scene->cameras.data();
      if (!first) courses.resize(3);
      for (const RightCourse& right : courses) {
        auto run = EngineRun::create(engine, from, right.course);
        ASSERT_TRUE(run) << run.error();
        const auto said = diagnose_right_frames(**run);
        ASSERT_TRUE(said) << said.error();
        EXPECT_EQ(*said, "") << name << ", camera " << from.name << ", " << right.name;
      }
    }
  }
}

}  // namespace
}  // namespace alcove::sample
