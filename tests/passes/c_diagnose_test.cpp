// Tests alcoveDiagnose on right frames of every kind of view, and how it forgets. tests/host makes
// each mistake on purpose.
#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "c_interface_fixture.h"
#include "diagnose/mistake_finder.h"
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
  for (const int i : {0, 5, 10, 15}) camera.view_from_world[i] = 1.0f;
  camera.view_from_world[12] = x;
  return camera;
}

// Returns the report on 40 frames with a moving camera. `change` changes every frame before it is
// observed. `speed` is the distance that the camera moves from frame to frame.
std::string said_of(const std::function<void(AlcoveFrame&, AlcoveView&)>& change,
                    float speed = 0.1f) {
  MistakeFinder finder;
  AlcoveSettings settings{.struct_size = sizeof settings};
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto at = [&](std::uint32_t frame) {
      return camera_at(speed * static_cast<float>(frame), 0.001f * static_cast<float>(frame % 7));
    };
    AlcoveView view{.struct_size = sizeof view, .id = 3, .settings = &settings};
    view.camera = at(i);
    view.previous_camera = i == 0 ? AlcoveCamera{} : at(i - 1);
    AlcoveFrame frame{.struct_size = sizeof frame, .index = i, .view_count = 1, .views = &view};
    change(frame, view);
    finder.observe(frame);
  }
  return finder.describe();
}

TEST(CDiagnose, CorrectCallsAreNotReportedAsMistakes) {
  for (const float speed : {0.0f, 1e-5f, 0.1f, 1e4f})
    EXPECT_EQ(said_of([](AlcoveFrame&, AlcoveView&) {}, speed), "") << speed;
  // The following calls are correct as well: a reset of the history in every fifth frame, pairs of
  // frames with the same index, as for the two eyes of a stereo view, and a game that starts anew.
  EXPECT_EQ(said_of([](AlcoveFrame& frame, AlcoveView& view) {
              view.reset_history = frame.index % 5 == 0 ? VK_TRUE : VK_FALSE;
              frame.index = frame.index % 25 / 2;
            }),
            "");
}

TEST(CDiagnose, IndexMayStandStillIfNoiseIsStatic) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  const auto said = [&](std::uint32_t history_frames, std::uint32_t static_noise) {
    settings.history_frames = history_frames;
    settings.static_noise = static_noise;
    return said_of([&](AlcoveFrame& frame, AlcoveView& view) {
      frame.index = frame.index / 8 % 2;
      view.settings = &settings;
    });
  };
  EXPECT_EQ(said(0, 1), "");
  for (const std::string& other : {said(0, 0), said(32, 1)}) {
    EXPECT_THAT(other, HasSubstr("AlcoveFrame::index stays the same"));
    EXPECT_THAT(other, HasSubstr("AlcoveFrame::index goes back"));
  }
}

TEST(CDiagnose, MistakeIsForgottenAfterItHasBeenMended) {
  const auto until = [](std::uint32_t end) {
    return [end](AlcoveFrame& frame, AlcoveView& view) {
      view.previous_camera = frame.index < end ? view.camera : view.previous_camera;
    };
  };
  EXPECT_THAT(said_of(until(40)), HasSubstr("View 3: previous_camera is this frame's camera"));
  EXPECT_EQ(said_of(until(30)), "");
}

TEST(CDiagnose, ViewsThatAreDroppedOrHaveNoHistoryMayBeManyMore) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  enum class Way { leak, drop, no_history };
  for (const Way way : {Way::leak, Way::drop, Way::no_history}) {
    settings.history_frames = way == Way::no_history ? 0 : 32;
    MistakeFinder finder;
    int warnings = 0;
    for (std::uint32_t i = 0; i < 100; ++i) {
      // A new view in every second frame, beside one that stays.
      const AlcoveView views[] = {
          {.struct_size = sizeof(AlcoveView), .id = 0, .settings = &settings},
          {.struct_size = sizeof(AlcoveView), .id = 1 + i / 2, .settings = &settings}};
      warnings += finder.observe(
          {.struct_size = sizeof(AlcoveFrame), .index = i, .view_count = 2, .views = views});
      if (way == Way::drop && i % 2 == 1) finder.drop_view(1 + i / 2);
    }
    EXPECT_EQ(warnings, way == Way::leak ? 1 : 0);
    EXPECT_EQ(finder.describe().find("More views") != std::string::npos, way == Way::leak);
  }
}

class CDiagnoseFrames : public CInterface {
 protected:
  // Records ten equal frames of a view and returns the text of alcoveDiagnose. If `discards` is
  // true, the frames are discarded.
  std::string said_of(const GivenView& given, bool discards = false) {
    const Context context = create_context();
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    view.previous_camera = view.camera;
    for (std::uint32_t i = 0; i < 10; ++i) {
      const AlcoveFrame frame{.struct_size = sizeof frame,
                              .index = i,
                              .slot = i % Engine::kSlots,
                              .view_count = 1,
                              .views = &view,
                              .diagnose_pixels = VK_TRUE};
      engine().submit(frame.slot, [&](VkCommandBuffer commands) {
        EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS)
            << alcoveGetMessage(context.get());
        if (discards) {
          throw_away(commands);
        }
      });
      if (discards) {
        EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS);
      }
    }
    engine().wait();
    std::string text(alcoveDiagnose(context.get(), nullptr, 0) + 1, '\0');
    alcoveDiagnose(context.get(), text.data(), text.size());
    text.pop_back();
    return text;
  }
};

TEST_F(CDiagnoseFrames, CorrectPixelsAreNotReportedAsMistakes) {
  for (const TestView& view : test_views()) {
    for (const NamedScene& scene : gtao_scenes()) {
      SCOPED_TRACE(view.name + ", " + scene.name);
      GivenView given = given_view(view, 96, 64, scene.scene);
      // A rotation that maps no axis of world space to an axis of view space.
      given.view.view_from_world = {0.36f, 0.48f, -0.8f, 0.0f, -0.8f, 0.6f,  0.0f, 0.0f,
                                    0.48f, 0.64f, 0.6f,  0.0f, 0.3f,  -1.0f, 2.0f, 1.0f};
      given.settings.steps = 2;
      given.motion = given.back_depth_ndc = given.second_depth_ndc = {};
      EXPECT_EQ(said_of(given), "");
    }
  }
}

TEST_F(CDiagnoseFrames, DiscardedFramesAreNotReportedAsMistakes) {
  EXPECT_EQ(said_of(given_view(test_views()[2], 96, 64, groove(0.8)), true), "");
}

TEST_F(CDiagnoseFrames, DiagnosisTextIsTruncatedToTheBufferOfTheCaller) {
  const Context context = create_context();
  EXPECT_EQ(alcoveDiagnose(context.get(), nullptr, 0), 0u);
  EXPECT_EQ(alcoveDiagnose(nullptr, nullptr, 0), 0u);
  GivenView given = given_view(test_views()[2], 16, 12, groove(0.8));
  AlcoveSettings settings{};
  const AlcoveView view = view_of(given, settings);
  for (std::uint32_t i = 0; i < 8; ++i) run_frame(*context, {&view, 1}, 4);
  engine().wait();
  std::string text(alcoveDiagnose(context.get(), nullptr, 0) + 1, '\0');
  EXPECT_EQ(alcoveDiagnose(context.get(), text.data(), text.size()), text.size() - 1);
  EXPECT_THAT(text, HasSubstr("View 0: AlcoveFrame::index stays the same"));
  char small[7];
  EXPECT_EQ(alcoveDiagnose(context.get(), small, sizeof small), text.size() - 1);
  EXPECT_STREQ(small, "View 0");
}

}  // namespace
}  // namespace alcove::passes
