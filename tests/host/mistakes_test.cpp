// Makes each usual mistake of integration from the first frame on, in the midst of frames that are
// right, and after a resize. Each must be named by its own sentence alone. Frames without a mistake
// must not be reported.
#include <gmock/gmock.h>

#include <algorithm>
#include <iostream>

#include "evaluate/errors.h"
#include "gpu_test.h"
#include "mistakes.h"
#include "scene/builtin_scene.h"
#include "scene/load_scene.h"

namespace alcove::sample {
namespace {

constexpr EngineCourse kQuick{.size = {120, 68}, .frames = 20, .quick = true};

// One device for all tests.
class Mistakes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    gpu_ = open_validated();
    ASSERT_TRUE(gpu_);
    const Scene& scene = builtin();
    const auto create = [&](EngineCourse course) {
      auto made = MistakeRun::create(*gpu_, scene, camera(), course);
      EXPECT_TRUE(made) << made.error();
      return made ? std::make_unique<MistakeRun>(std::move(*made)) : nullptr;
    };
    whole_ = create({});
    run_ = create(kQuick);
    EngineCourse resized = kQuick;
    resized.resize = true;
    resized_ = create(resized);
    ASSERT_TRUE(whole_ && run_ && resized_);
  }
  static void TearDownTestSuite() {
    whole_.reset();
    run_.reset();
    resized_.reset();
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
  static inline std::unique_ptr<MistakeRun> whole_;  // with the samples of `medium`
  static inline std::unique_ptr<MistakeRun> run_;
  static inline std::unique_ptr<MistakeRun> resized_;
};

TEST_F(Mistakes, AtLeastSixtyMistakesArePlanted) { EXPECT_GE(planted_mistakes().size(), 60u); }

// Also prints the RMSE of the table of passes/INTEGRATION.md.
TEST_F(Mistakes, EachMistakeIsNamedIfItIsMadeFromTheFirstFrameOn) {
  const auto plain = whole_->draw_right(false);
  const auto reversed = whole_->draw_right(true);
  ASSERT_TRUE(plain && reversed);
  for (const PlantedMistake& mistake : planted_mistakes()) {
    const Image<float> drawn = expect_named(*whole_, mistake, 0);
    if (drawn.empty()) continue;  // the frames were refused
    const Image<float>& right = (mistake.reversed ? reversed : plain)->visibility;
    const Mask all(right.width, right.height, 1);
    std::cout << compare_images(drawn, right, all).rmse << "  " << mistake.name << " "
              << mistake.table_name << "\n";
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
    const auto scene = load_scene(name);
    ASSERT_TRUE(scene) << scene.error();
    EngineCourse course = kQuick;
    course.radius = default_radius(*scene);
    for (Camera from : scene->cameras) {
      from.reversed_z = true;
      for (const RightCourse& right : right_courses(course)) {
        auto run = EngineRun::create(*gpu_, *scene, from, right.course);
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
