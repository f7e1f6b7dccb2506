// Tests that alcoveDiagnose reports mistakes in the arguments of calls. Each mistake is made on
// purpose and must be reported; correct calls must not be.
#include <gmock/gmock.h>

#include <functional>

#include "c_interface_fixture.h"
#include "diagnose/call_observer.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

AlcoveCamera camera_at(float x, float jitter) {
  AlcoveCamera camera{};
  camera.clip_from_view[0] = camera.clip_from_view[5] = 1.0f;
  camera.clip_from_view[8] = jitter;
  camera.clip_from_view[11] = -1.0f;
  camera.clip_from_view[14] = 0.1f;
  for (const int i : {0, 5, 10, 15}) {
    camera.view_from_world[i] = 1.0f;
  }
  camera.view_from_world[12] = x;
  return camera;
}

// Returns the report on 20 frames with a moving camera. `spoil` changes every frame before it is
// observed. `speed` is the distance that the camera moves from frame to frame.
std::string said_of(const std::function<void(AlcoveFrame&, AlcoveView&)>& spoil,
                    float speed = 0.1f) {
  CallObserver observer;
  AlcoveSettings settings{.struct_size = sizeof settings};
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const auto at = [&](std::uint32_t frame) {
      return camera_at(speed * static_cast<float>(frame), 0.001f * static_cast<float>(frame % 7));
    };
    AlcoveView view{.struct_size = sizeof view, .id = 3, .settings = &settings};
    view.camera = at(i);
    view.previous_camera = i == 0 ? AlcoveCamera{} : at(i - 1);
    AlcoveFrame frame{.struct_size = sizeof frame, .index = i, .view_count = 1, .views = &view};
    spoil(frame, view);
    observer.observe(frame);
  }
  return observer.describe();
}

TEST(CDiagnose, CorrectCallsAreNotReportedAsMistakes) {
  for (const float speed : {0.0f, 1e-5f, 0.1f, 1e4f}) {
    EXPECT_EQ(said_of([](AlcoveFrame&, AlcoveView&) {}, speed), "") << speed;
  }
  // The following calls are correct as well: a reset of the history in every fifth frame, and pairs
  // of frames with the same index, as for the two eyes of a stereo view.
  EXPECT_EQ(said_of([](AlcoveFrame& frame, AlcoveView& view) {
              view.reset_history = frame.index % 5 == 0 ? VK_TRUE : VK_FALSE;
              frame.index /= 2;
            }),
            "");
}

TEST(CDiagnose, FrameIndexThatNeverChangesIsReported) {
  EXPECT_THAT(said_of([](AlcoveFrame& frame, AlcoveView&) { frame.index = 7; }),
              HasSubstr("AlcoveFrame::index has been 7 in 20 frames in a row"));
}

TEST(CDiagnose, PreviousCameraEqualToTheCurrentOneInEveryMovingFrameIsReported) {
  EXPECT_THAT(said_of([](AlcoveFrame&, AlcoveView& view) { view.previous_camera = view.camera; }),
              HasSubstr("View 3: previous_camera is this frame's camera"));
}

TEST(CDiagnose, PreviousCameraThatNeverEqualsTheLastFramesCameraIsReported) {
  EXPECT_THAT(said_of([](AlcoveFrame&, AlcoveView& view) {
                view.previous_camera = camera_at(-5.0f, 0.0f);
              }),
              HasSubstr("View 3: previous_camera is never"));
}

TEST(CDiagnose, JitterInOnlyOneOfCurrentAndPreviousCameraIsReported) {
  EXPECT_THAT(
      said_of([](AlcoveFrame&, AlcoveView& view) { view.camera.clip_from_view[8] += 0.5f; }),
      HasSubstr("jitter included"));
}

TEST(CDiagnose, StaticFrameCountWhileTheCameraMovesAndHistoryResetInEveryFrameAreReported) {
  EXPECT_THAT(said_of([](AlcoveFrame&, AlcoveView& view) { view.static_frames = 1; }),
              HasSubstr("View 3: static_frames"));
  EXPECT_THAT(said_of([](AlcoveFrame&, AlcoveView& view) { view.reset_history = VK_TRUE; }),
              HasSubstr("View 3: reset_history"));
}

class CDiagnoseFrames : public CInterface {};

TEST_F(CDiagnoseFrames, DiagnosisTextIsTruncatedToTheBufferOfTheCaller) {
  const Context context = create_context();
  EXPECT_EQ(alcoveDiagnose(context.get(), nullptr, 0), 0u);
  EXPECT_EQ(alcoveDiagnose(nullptr, nullptr, 0), 0u);
  GivenView given = given_view(test_views()[2], 16, 12, groove(0.8));
  AlcoveSettings settings{};
  const AlcoveView view = view_of(given, settings);
  for (std::uint32_t i = 0; i < 8; ++i) {
    run_frame(*context, {&view, 1}, 4);
  }
  engine().wait();
  std::string text(alcoveDiagnose(context.get(), nullptr, 0) + 1, '\0');
  EXPECT_EQ(alcoveDiagnose(context.get(), text.data(), text.size()), text.size() - 1);
  EXPECT_THAT(text, HasSubstr("AlcoveFrame::index has been 4 in 8 frames in a row"));
  char small[12];
  EXPECT_EQ(alcoveDiagnose(context.get(), small, sizeof small), text.size() - 1);
  EXPECT_STREQ(small, "AlcoveFrame");
}

}  // namespace
}  // namespace alcove::passes
