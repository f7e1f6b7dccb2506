// Makes each usual mistake of integration from the first frame on, in the midst of frames that are
// right, and after a resize. Each must be named by its own sentence alone. Frames without a mistake
// must not be reported.
#include <gmock/gmock.h>

#include "evaluate/mistakes.h"
#include "gpu_test.h"
#include "scene/builtin_scene.h"

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
    run_ = create(kQuick);
    EngineCourse resized = kQuick;
    resized.resize = true;
    resized_ = create(resized);
    ASSERT_TRUE(run_ && resized_);
  }
  static void TearDownTestSuite() {
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

  static void expect_named(MistakeRun& run, const PlantedMistake& mistake, std::uint32_t begin) {
    const auto drawn = run.draw(mistake, begin);
    ASSERT_TRUE(drawn) << drawn.error();
    EXPECT_TRUE(names(drawn->said, mistake))
        << mistake.name << ", from frame " << begin << ": " << drawn->said;
  }

  static inline ValidatedGpu gpu_;
  static inline std::unique_ptr<MistakeRun> run_;
  static inline std::unique_ptr<MistakeRun> resized_;
};

TEST_F(Mistakes, AtLeastSixtyMistakesArePlanted) { EXPECT_GE(planted_mistakes().size(), 60u); }

TEST_F(Mistakes, EachMistakeIsNamedIfItIsMadeFromTheFirstFrameOn) {
  for (const PlantedMistake& mistake : planted_mistakes()) expect_named(*run_, mistake, 0);
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAmongRightFrames) {
  for (const PlantedMistake& mistake : planted_mistakes()) expect_named(*run_, mistake, 10);
}

TEST_F(Mistakes, EachMistakeIsNamedIfItBeginsAfterAResize) {
  for (const PlantedMistake& mistake : planted_mistakes())
    expect_named(*resized_, mistake, kQuick.change_at + 1);
}

TEST_F(Mistakes, RightFramesAreNotReported) {
  for (const RightCourse& right : right_courses(kQuick)) {
    auto run = EngineRun::create(*gpu_, builtin(), camera(), right.course);
    ASSERT_TRUE(run) << run.error();
    const auto said = diagnose_right_frames(**run);
    ASSERT_TRUE(said) << said.error();
    EXPECT_EQ(*said, "") << right.name;
  }
}

}  // namespace
}  // namespace alcove::sample
