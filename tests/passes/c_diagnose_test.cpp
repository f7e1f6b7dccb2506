// Tests alcoveDiagnose on correct frames of every kind of view, and how it forgets. tests/host
// makes each mistake on purpose.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <string>

#include "c_interface_fixture.h"
#include "diagnose/mistake_finder.h"

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
std::string diagnose(const std::function<void(AlcoveFrame&, AlcoveView&)>& change,
                     float speed = 0.1f) {
  MistakeFinder finder;
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 1.0f);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto at = [&](std::uint32_t frame) {
      return camera_at(speed * static_cast<float>(frame), 0.001f * static_cast<float>(frame % 7));
    };
    AlcoveView view{.struct_size = sizeof view, .info = {.id = 3, .settings = &settings}};
    view.info.camera = at(i);
    view.info.previous_camera = i == 0 ? AlcoveCamera{} : at(i - 1);
    AlcoveFrame frame{.struct_size = sizeof frame, .index = i, .view_count = 1, .views = &view};
    change(frame, view);
    finder.observe(frame);
  }
  return finder.describe();
}

TEST(CDiagnose, CorrectCallsAreNotReportedAsMistakes) {
  for (const float speed : {0.0f, 1e-5f, 0.1f, 1e4f})
    EXPECT_EQ(diagnose([](AlcoveFrame&, AlcoveView&) {}, speed), "") << speed;
  // The following calls are correct as well: cuts, pairs of frames with the same index for the two
  // eyes of a stereo view, each with its own id, and a game that starts anew.
  EXPECT_EQ(diagnose([](AlcoveFrame& frame, AlcoveView& view) {
              const std::uint32_t pair = frame.index / 2;
              view.info.id = frame.index % 2;
              view.info.camera = camera_at(0.1f * static_cast<float>(pair), 0.0f);
              view.info.previous_camera = camera_at(0.1f * (static_cast<float>(pair) - 1.0f), 0.0f);
              view.info.reset_history = pair % 8 == 0 ? VK_TRUE : VK_FALSE;
              frame.index = pair % 12;
            }),
            "");
}

TEST(CDiagnose, IndexMayStandStillIfNoiseIsStatic) {
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 1.0f);
  const auto diagnose_noise = [&](std::uint32_t history_frames, std::uint32_t static_noise) {
    settings.history_frames = history_frames;
    settings.static_noise = static_noise;
    return diagnose([&](AlcoveFrame& frame, AlcoveView& view) {
      frame.index = frame.index / 8 % 2;
      view.info.settings = &settings;
    });
  };
  EXPECT_EQ(diagnose_noise(0, 1), "");
  for (const std::string& other : {diagnose_noise(0, 0), diagnose_noise(32, 1)}) {
    EXPECT_THAT(other, HasSubstr("AlcoveFrame::index is that of the last record"));
    EXPECT_THAT(other, HasSubstr("AlcoveFrame::index goes back"));
  }
}

TEST(CDiagnose, MistakeIsForgottenAfterItHasBeenMended) {
  const auto until = [](std::uint32_t end) {
    return [end](AlcoveFrame& frame, AlcoveView& view) {
      view.info.previous_camera = frame.index < end ? view.info.camera : view.info.previous_camera;
    };
  };
  EXPECT_THAT(diagnose(until(40)), HasSubstr("View 3: previous_camera is this frame's camera"));
  EXPECT_EQ(diagnose(until(30)), "");
}

TEST(CDiagnose, SentenceLeavesAfterFramesThatCannotShowTheMistake) {
  const auto stops_at = [](std::uint32_t end) {
    return [end](AlcoveFrame& frame, AlcoveView& view) {
      if (frame.index >= end)
        view.info.camera = camera_at(0.1f * static_cast<float>(end - 1), 0.0f);
      view.info.previous_camera = view.info.camera;
    };
  };
  EXPECT_THAT(diagnose(stops_at(30)), HasSubstr("previous_camera is this frame's camera"));
  EXPECT_EQ(diagnose(stops_at(7)), "");
}

// The eyes are `distance` apart on a path along x.
TEST(CDiagnose, EyesThatAlternateAreToldFromACameraThatTrembles) {
  const auto diagnose_eyes = [](float speed, float distance) {
    return diagnose([&](AlcoveFrame& frame, AlcoveView& view) {
      const auto at = [&](std::uint32_t i) {
        return camera_at(speed * static_cast<float>(i) + distance * static_cast<float>(i % 2),
                         0.0f);
      };
      view.info.camera = at(frame.index);
      view.info.previous_camera = at(frame.index == 0 ? 0 : frame.index - 1);
    });
  };
  EXPECT_THAT(diagnose_eyes(0.0f, 0.3f), HasSubstr("as if two eyes alternated"));
  EXPECT_THAT(diagnose_eyes(0.5f, 0.3f), HasSubstr("as if two eyes alternated"));
  EXPECT_EQ(diagnose_eyes(0.0f, 0.01f), "");
}

TEST(CDiagnose, HalfResolutionThatChangesAgainAndAgainIsReported) {
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 1.0f);
  const auto diagnose_changes = [&](std::uint32_t frames) {
    return diagnose([&](AlcoveFrame& frame, AlcoveView& view) {
      settings.half_resolution = frame.index / frames % 2;
      view.info.settings = &settings;
    });
  };
  EXPECT_THAT(diagnose_changes(1), HasSubstr("half_resolution changes again and again"));
  EXPECT_EQ(diagnose_changes(20), "");
}

TEST(CDiagnose, ViewsThatAreDroppedOrHaveNoHistoryMayBeManyMore) {
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 1.0f);
  enum class Way { leak, drop, no_history };
  for (const Way way : {Way::leak, Way::drop, Way::no_history}) {
    settings.history_frames = way == Way::no_history ? 0 : 32;
    MistakeFinder finder;
    int warnings = 0;
    for (std::uint32_t i = 0; i < 100; ++i) {
      // A new view in every second frame, beside one that stays.
      const AlcoveView views[] = {
          {.struct_size = sizeof(AlcoveView), .info = {.id = 0, .settings = &settings}},
          {.struct_size = sizeof(AlcoveView), .info = {.id = 1 + i / 2, .settings = &settings}}};
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
  // Records ten equal frames of a view and returns the text of alcoveDiagnose.
  std::string diagnose(const HostView& from, bool discards = false) {
    AlcoveView view = create_view(from);
    view.info.id = next_id_++;
    view.info.previous_camera = view.info.camera;
    for (std::uint32_t i = 0; i < 10; ++i) {
      AlcoveFrame frame = make_frame({&view, 1}, i);
      frame.diagnose_pixels = VK_TRUE;
      EXPECT_EQ(record(context(), frame, discards), ALCOVE_SUCCESS) << alcoveGetMessage(&context());
      if (discards) {
        EXPECT_EQ(alcoveDiscardFrame(&context()), ALCOVE_SUCCESS);
      }
    }
    engine().wait();
    EXPECT_EQ(alcoveDropView(&context(), view.info.id), ALCOVE_SUCCESS);
    return print_diagnosis(context());
  }
  static std::string print_diagnosis(AlcoveContext& context) {
    return print(
        [&](char* text, std::size_t size) { return alcoveDiagnose(&context, text, size); });
  }

 private:
  std::uint32_t next_id_ = 0;
};

TEST_F(CDiagnoseFrames, CorrectPixelsAreNotReportedAsMistakes) {
  for (const TestView& view : test_views()) {
    for (const NamedScene& scene : gtao_scenes()) {
      SCOPED_TRACE(view.name + ", " + scene.name);
      HostView from = draw_view(96, 64, scene.scene, view);
      // A rotation that maps no axis of world space to an axis of view space.
      constexpr float kTurned[16] = {0.36f, 0.48f, -0.8f, 0.0f, -0.8f, 0.6f,  0.0f, 0.0f,
                                     0.48f, 0.64f, 0.6f,  0.0f, 0.3f,  -1.0f, 2.0f, 1.0f};
      std::ranges::copy(kTurned, from.view.view_from_world);
      from.settings.steps = 2;
      from.motion = from.back_depth_ndc = from.second_depth_ndc = {};
      EXPECT_EQ(diagnose(from), "");
    }
  }
}

TEST_F(CDiagnoseFrames, DiscardedFramesAreNotReportedAsMistakes) {
  EXPECT_EQ(diagnose(draw_view(96, 64, groove(0.8)), true), "");
}

TEST_F(CDiagnoseFrames, DiagnosisTextIsTruncatedToTheBufferOfTheCaller) {
  const Context context = create_context();
  EXPECT_EQ(print_diagnosis(*context), "");
  const AlcoveView view = create_view(draw_view(16, 12));
  for (std::uint32_t i = 0; i < 8; ++i) run_frame(*context, {&view, 1}, 4);
  engine().wait();
  const std::string text = print_diagnosis(*context);
  EXPECT_THAT(text, HasSubstr("View 0: AlcoveFrame::index is that of the last record"));
  char small[7];
  EXPECT_EQ(alcoveDiagnose(context.get(), small, sizeof small), text.size());
  EXPECT_STREQ(small, "View 0");
}

}  // namespace
}  // namespace alcove::passes
