// Tests that invalid input of any kind gives an error value and a message of one sentence, that
// nothing is recorded then, and that the next frame is the same as without the invalid call.
#include <gmock/gmock.h>

#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

bool is_a_sentence(const std::string& text) {
  return !text.empty() && text.back() == '.' && std::isupper(static_cast<unsigned char>(text[0]));
}

// Sets an enum of the C interface to a number that need not be one of its enumerators.
template <typename Enum>
void set_number(Enum& value, std::uint32_t number) {
  std::memcpy(&value, &number, sizeof number);
}

class CBadInput : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    if (HasFatalFailure()) return;
    context_ = create_context();
    given_ = given_view(test_views()[2], 16, 12, groove(0.8));
    given_.settings.bent_normal = true;
    given_.settings.specular = Specular::slices;
    given_.multi_bounce = true;
    view_ = view_of(given_, settings_);
  }
  void TearDown() override {
    if (engine_is_there()) engine().wait();
    context_.reset();
    CInterface::TearDown();
  }
  bool engine_is_there() { return context_ != nullptr; }

  struct Spoilt {
    AlcoveFrame frame;
    std::array<AlcoveView, 9> views;
    AlcoveSettings settings;
    AlcoveAdvancedSettings advanced;
  };
  // Makes a valid frame invalid with `spoil` and gives it to alcovePrepareFrame and to
  // alcoveRecordFrame. Expects the same error from both and returns its message.
  std::string error_of(const std::function<void(Spoilt&)>& spoil) {
    Spoilt spoilt{};
    spoilt.settings = settings_;
    spoilt.advanced = *settings_.advanced;
    spoilt.settings.advanced = &spoilt.advanced;
    spoilt.views.fill(view_);
    for (std::uint32_t i = 0; i < spoilt.views.size(); ++i) {
      spoilt.views.at(i).id = i;
      spoilt.views.at(i).settings = &spoilt.settings;
    }
    spoilt.frame = {.struct_size = sizeof(AlcoveFrame),
                    .slot = 1,
                    .view_count = 1,
                    .views = spoilt.views.data()};
    spoil(spoilt);
    EXPECT_EQ(alcovePrepareFrame(context_.get(), &spoilt.frame), ALCOVE_ERROR_INVALID_INPUT);
    std::string said = alcoveGetMessage(context_.get());
    engine().submit(1, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context_.get(), commands, &spoilt.frame),
                ALCOVE_ERROR_INVALID_INPUT);
    });
    EXPECT_EQ(said, alcoveGetMessage(context_.get()));
    return said;
  }

  void expect_a_good_frame() {
    run_frame(*context_, {&view_, 1}, 0);
    engine().wait();
    given_.reset = true;  // by C the view was never recorded before
    expect_equal(results_of(view_), run_by_cpp(given_, 0));
  }

  AlcoveContext* context() { return context_.get(); }
  AlcoveView& view() { return view_; }

 private:
  Context context_;
  GivenView given_;
  AlcoveSettings settings_{};
  AlcoveView view_{};
};

TEST_F(CBadInput, InvalidFrameDescriptionIsReported) {
  struct Case {
    const char* names;
    std::function<void(Spoilt&)> spoil;
  };
  const Case cases[] = {
      {"AlcoveFrame::struct_size is 0", [](Spoilt& s) { s.frame.struct_size = 0; }},
      {"AlcoveFrame::struct_size", [](Spoilt& s) { s.frame.struct_size = ~0u; }},
      {"slot is 2", [](Spoilt& s) { s.frame.slot = 2; }},
      {"slot is 4294967295", [](Spoilt& s) { s.frame.slot = ~0u; }},
      {"0 views", [](Spoilt& s) { s.frame.view_count = 0; }},
      {"9 views", [](Spoilt& s) { s.frame.view_count = 9; }},
      {"0 views", [](Spoilt& s) { s.frame.views = nullptr; }},
      {"AlcoveView::struct_size", [](Spoilt& s) { s.views[0].struct_size -= 1; }},
      {"id 1",
       [](Spoilt& s) {
         s.frame.view_count = 2;
         s.views[0].id = s.views[1].id;
       }},
      {"no settings", [](Spoilt& s) { s.views[0].settings = nullptr; }},
      {"given twice", [](Spoilt& s) { s.frame.view_count = 2; }},
  };
  for (const Case& bad : cases) {
    const std::string said = error_of(bad.spoil);
    EXPECT_THAT(said, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(CBadInput, SettingsOutOfRangeAreReportedByName) {
  struct Case {
    const char* names;
    std::function<void(AlcoveSettings&, AlcoveAdvancedSettings&)> spoil;
  };
  using S = AlcoveSettings;
  using A = AlcoveAdvancedSettings;
  const Case cases[] = {
      {"AlcoveSettings::struct_size", [](S& s, A&) { s.struct_size = 4; }},
      {"AlcoveAdvancedSettings::struct_size is 4;", [](S&, A& a) { a.struct_size = 4; }},
      {"'radius' is 0;", [](S& s, A&) { s.radius = 0.0f; }},
      {"'radius' is nan;", [](S& s, A&) { s.radius = kNaN; }},
      {"'slices' is 65;", [](S& s, A&) { s.slices = 65; }},
      {"'steps' is 1;", [](S& s, A&) { s.steps = 1; }},
      {"'estimator' is 3; it must be horizons,", [](S&, A& a) { set_number(a.estimator, 3); }},
      {"'estimator' is 255;", [](S&, A& a) { set_number(a.estimator, ~0u); }},
      {"'thickness' is nan;", [](S& s, A&) { s.thickness = kNaN; }},
      {"'thickness_unit' is 3;", [](S&, A& a) { set_number(a.thickness_unit, 3); }},
      {"'hidden_occlusion' is 1.5;", [](S& s, A&) { s.hidden_occlusion = 1.5f; }},
      {"'falloff' is 2;", [](S&, A& a) { a.falloff = 2.0f; }},
      {"'falloff' is 0.5 with the estimator connected", [](S&, A& a) { a.falloff = 0.5f; }},
      {"'tile_size' is 3; it must be 1, 2, 4 or 8.", [](S& s, A&) { s.tile_size = 3; }},
      {"'filter_radius' is 4;", [](S&, A& a) { a.filter_radius = 4; }},
      {"'filter_tolerance_px' is 0;", [](S&, A& a) { a.filter_tolerance_px = 0.0f; }},
      {"'history_frames' is 128; it must be 0 to 127.", [](S& s, A&) { s.history_frames = 128; }},
      {"'clamp_width' is nan;", [](S&, A& a) { a.clamp_width = kNaN; }},
      {"'specular' is 0;", [](S& s, A&) { set_number(s.specular, 0); }},
      {"'specular' is 4;", [](S& s, A&) { set_number(s.specular, 4); }},
      {"'roughness' is nan;", [](S& s, A&) { s.roughness = kNaN; }},
      {"'roughness_channel' is 7;", [](S& s, A&) { s.roughness_channel = 7; }},
      {"'precision' is 3;", [](S& s, A&) { set_number(s.precision, 3); }},
  };
  for (const Case& bad : cases) {
    const std::string said = error_of([&](Spoilt& s) {
      s.views[0].roughness = {};
      bad.spoil(s.settings, s.advanced);
    });
    EXPECT_THAT(said, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(CBadInput, InvalidCameraMatricesAreReported) {
  struct Case {
    const char* names;
    std::function<void(AlcoveView&)> spoil;
  };
  const Case cases[] = {
      {"The view cannot be used: view_from_world",
       [](AlcoveView& v) { v.camera.view_from_world[13] = kNaN; }},
      {"The view cannot be used: view_from_world",
       [](AlcoveView& v) { v.camera.view_from_world[0] = kNaN; }},
      {"The view cannot be used: view_from_world",
       [](AlcoveView& v) { v.camera.view_from_world[0] = 2.0f; }},
      // In a row-major matrix the translation lies where this matrix has its last row.
      {"column-major", [](AlcoveView& v) { v.camera.view_from_world[3] = 5.0f; }},
      {"The view cannot be used", [](AlcoveView& v) { v.camera.clip_from_view[0] = kNaN; }},
      {"The view cannot be used", [](AlcoveView& v) { v.camera.clip_from_view[11] = 1.0f; }},
  };
  for (const Case& bad : cases) {
    const std::string said = error_of([&](Spoilt& s) { bad.spoil(s.views[0]); });
    EXPECT_THAT(said, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(CBadInput, PreviousCameraIsCheckedOnlyIfTheViewHasHistoryContents) {
  view().previous_camera = {};
  const AlcoveFrame frame{
      .struct_size = sizeof(AlcoveFrame), .index = 0, .view_count = 1, .views = &view()};
  EXPECT_EQ(alcovePrepareFrame(context(), &frame), ALCOVE_SUCCESS) << alcoveGetMessage(context());
  run_frame(*context(), {&view(), 1}, 0);  // the view's first frame
  engine().submit(1, [&](VkCommandBuffer commands) {
    EXPECT_EQ(alcoveRecordFrame(context(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
  });
  const std::string said = alcoveGetMessage(context());
  EXPECT_THAT(said, HasSubstr("The previous view cannot be used"));
  EXPECT_THAT(said, HasSubstr("reset_history"));
  EXPECT_PRED1(is_a_sentence, said);
  view().reset_history = VK_TRUE;
  expect_a_good_frame();
}

TEST_F(CBadInput, PreviousCameraAndImageSizesAreIgnoredIfHistoryIsOff) {
  AlcoveSettings settings = *view().settings;
  settings.history_frames = 0;
  AlcoveView alone = view();
  alone.settings = &settings;
  run_frame(*context(), {&alone, 1}, 0);
  engine().wait();
  const Results expected = results_of(alone);
  alone.previous_camera = {};
  alone.previous_width = alone.previous_height = 1000;
  alone.largest_width = 1;
  run_frame(*context(), {&alone, 1}, 0);
  engine().wait();
  expect_equal(results_of(alone), expected);
}

TEST_F(CBadInput, ImageOfWrongSizeFormatUsageOrLayoutIsReported) {
  struct Case {
    const char* names;
    std::function<void(AlcoveView&)> spoil;
  };
  const Case cases[] = {
      {"no image of depth", [](AlcoveView& v) { v.depth = {}; }},
      {"depth is 0x12", [](AlcoveView& v) { v.depth.width = 0; }},
      {"normals is 16x0", [](AlcoveView& v) { v.normals.height = 0; }},
      {"depth", [](AlcoveView& v) { v.depth.format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"depth", [](AlcoveView& v) { v.depth.format = VK_FORMAT_UNDEFINED; }},
      {"normals is 15x12", [](AlcoveView& v) { v.normals.width = 15; }},
      {"normals has the format VK_FORMAT_R8G8B8A8_UNORM",
       [](AlcoveView& v) { v.normals.format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"normals has the format VK_FORMAT",
       [](AlcoveView& v) { v.normals.format = VK_FORMAT_R16G16_SFLOAT; }},
      {"motion vectors has the format VK_FORMAT",
       [](AlcoveView& v) { v.motion.format = VK_FORMAT_R32G32_UINT; }},
      {"roughness has the format VK_FORMAT",
       [](AlcoveView& v) { v.roughness.format = VK_FORMAT_R8_UNORM; }},
      {"back-face depth is 16x13", [](AlcoveView& v) { v.back_depth.height = 13; }},
      {"second depth is 16x13", [](AlcoveView& v) { v.second_depth.height = 13; }},
      {"albedo has the format VK_FORMAT",
       [](AlcoveView& v) { v.albedo.format = VK_FORMAT_BC7_SRGB_BLOCK; }},
      {"no image of albedo", [](AlcoveView& v) { v.albedo = {}; }},
      {"visibility has the format VK_FORMAT",
       [](AlcoveView& v) { v.visibility.format = VK_FORMAT_D32_SFLOAT; }},
      {"bent normals has the format VK_FORMAT",
       [](AlcoveView& v) { v.bent_normal.format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"visibility of view 0' with usage SAMPLED",
       [](AlcoveView& v) { v.visibility.usage = VK_IMAGE_USAGE_STORAGE_BIT; }},
      {"multi-bounce has the format VK_FORMAT",
       [](AlcoveView& v) { v.multi_bounce.format = VK_FORMAT_R32_SFLOAT; }},
      {"specular occlusion is 1x1",
       [](AlcoveView& v) { v.specular.width = v.specular.height = 1; }},
      {"without VK_IMAGE_USAGE_SAMPLED_BIT", [](AlcoveView& v) { v.albedo.usage = 0; }},
      {"without VK_IMAGE_USAGE_STORAGE_BIT",
       [](AlcoveView& v) { v.bent_normal.usage = VK_IMAGE_USAGE_SAMPLED_BIT; }},
      // The multi-bounce pass samples the image of visibility, which therefore needs the usage
      // SAMPLED.
      {"visibility of view 0",
       [](AlcoveView& v) { v.visibility.usage = VK_IMAGE_USAGE_STORAGE_BIT; }},
      {"no layout to be left in",
       [](AlcoveView& v) { v.specular.final_state.layout = VK_IMAGE_LAYOUT_UNDEFINED; }},
      {"without contents",
       [](AlcoveView& v) { v.depth.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED; }},
      {"given twice", [](AlcoveView& v) { v.specular = v.visibility; }},
      {"given twice",
       [](AlcoveView& v) {
         v.motion = v.roughness;
         v.motion.final_state.stages = VK_PIPELINE_STAGE_2_COPY_BIT;
       }},
      {"no image to write to",
       [](AlcoveView& v) {
         v.visibility = v.bent_normal = v.specular = v.multi_bounce = AlcoveImage{};
       }},
  };
  for (const Case& bad : cases) {
    const std::string said = error_of([&](Spoilt& s) { bad.spoil(s.views[0]); });
    EXPECT_THAT(said, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(CBadInput, MissingBackFaceDepthIsReportedIfTheSettingsNeedIt) {
  const std::string said = error_of([](Spoilt& s) {
    s.advanced.thickness_unit = ALCOVE_THICKNESS_UNIT_BACK_FACES;
    s.views[0].back_depth = {};
  });
  EXPECT_THAT(said, HasSubstr("no image of back_depth"));
  EXPECT_PRED1(is_a_sentence, said);
}

TEST_F(CBadInput, MissingSecondDepthLayerIsReportedIfTheSettingsNeedIt) {
  const std::string said = error_of([](Spoilt& s) {
    s.settings.depth_layers = 2;
    s.views[0].second_depth = {};
  });
  EXPECT_THAT(said, HasSubstr("no image of second_depth"));
  EXPECT_PRED1(is_a_sentence, said);
}

TEST_F(CBadInput, NullPointerArgumentsAreErrors) {
  AlcoveFrame frame{.struct_size = sizeof frame};
  EXPECT_EQ(alcoveRecordFrame(context(), VK_NULL_HANDLE, &frame), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(alcoveGetMessage(context()), HasSubstr("command buffer"));
  EXPECT_EQ(alcoveRecordFrame(nullptr, VK_NULL_HANDLE, &frame), ALCOVE_ERROR_INVALID_INPUT);
  engine().submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(alcoveRecordFrame(context(), commands, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  });
  EXPECT_EQ(alcovePrepareFrame(nullptr, &frame), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcovePrepareFrame(context(), nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(alcoveGetMessage(context()), HasSubstr("no AlcoveFrame"));
  EXPECT_EQ(alcoveGetMemory(context(), nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetMemory(nullptr, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  AlcoveMemory memory{};
  EXPECT_EQ(alcoveGetMemory(context(), &memory), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(alcoveGetMessage(context()), HasSubstr("AlcoveMemory::struct_size"));
  std::uint32_t count = 0;
  EXPECT_EQ(alcoveGetTimings(context(), 0, nullptr, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetTimings(context(), 2, &count, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetTimings(nullptr, 0, &count, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcovePrintPlan(nullptr, nullptr, 0), 0u);
  EXPECT_EQ(alcoveDropView(nullptr, 0), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveForgetImage(nullptr, VK_NULL_HANDLE), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveForgetImage(context(), VK_NULL_HANDLE), ALCOVE_SUCCESS);
  EXPECT_STRNE(alcoveGetMessage(nullptr), "");
  alcoveDestroyContext(nullptr);
  expect_a_good_frame();
}

TEST_F(CBadInput, InvalidCreationInfoOfAContextIsReported) {
  struct Case {
    const char* names;
    std::function<void(AlcoveContextInfo&)> spoil;
  };
  const Case cases[] = {
      {"struct_size", [](AlcoveContextInfo& i) { i.struct_size = 0; }},
      {"instance is null", [](AlcoveContextInfo& i) { i.instance = VK_NULL_HANDLE; }},
      {"physical_device is null", [](AlcoveContextInfo& i) { i.physical_device = VK_NULL_HANDLE; }},
      {"device is null", [](AlcoveContextInfo& i) { i.device = VK_NULL_HANDLE; }},
      {"get_instance_proc_addr is null",
       [](AlcoveContextInfo& i) { i.get_instance_proc_addr = nullptr; }},
      {"frames_in_flight is 0", [](AlcoveContextInfo& i) { i.frames_in_flight = 0; }},
      {"frames_in_flight is 9", [](AlcoveContextInfo& i) { i.frames_in_flight = 9; }},
      {"queue_family is 4294967295", [](AlcoveContextInfo& i) { i.queue_family = ~0u; }},
  };
  char message[ALCOVE_MAX_MESSAGE];
  for (const Case& bad : cases) {
    AlcoveContextInfo info = engine().context_info();
    bad.spoil(info);
    AlcoveContext* made = context();
    EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(made, nullptr);
    EXPECT_THAT(message, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, message);
  }
  AlcoveContext* made = nullptr;
  EXPECT_EQ(alcoveCreateContext(nullptr, &made, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  const AlcoveContextInfo info = engine().context_info();
  EXPECT_EQ(alcoveCreateContext(&info, nullptr, message), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_PRED1(is_a_sentence, message);
}

TEST_F(CBadInput, RequestingSettingsWithUnknownQualityOrInvalidRadiusIsAnError) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  AlcoveQuality quality = ALCOVE_QUALITY_LOW;
  EXPECT_EQ(alcoveGetSettings(quality, 1.0f, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  for (const float radius : {0.0f, -1.0f, kNaN, std::numeric_limits<float>::infinity()})
    EXPECT_EQ(alcoveGetSettings(quality, radius, &settings), ALCOVE_ERROR_INVALID_INPUT);
  set_number(quality, ALCOVE_QUALITY_REFERENCE + 1);
  EXPECT_EQ(alcoveGetSettings(quality, 1.0f, &settings), ALCOVE_ERROR_INVALID_INPUT);
  settings.struct_size = 12;
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, 1.0f, &settings), ALCOVE_ERROR_INVALID_INPUT);
  char text[64] = "before";
  EXPECT_EQ(alcovePrintSettings(&settings, text, sizeof text), 0u);
  EXPECT_STREQ(text, "");
  EXPECT_EQ(alcovePrintSettings(nullptr, text, sizeof text), 0u);
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, 1.0f, nullptr), ALCOVE_ERROR_INVALID_INPUT);
}

// Random numbers in settings and cameras never crash: either the frame is recorded, or it is
// refused with a sentence.
TEST_F(CBadInput, FramesWithRandomSettingsAndCamerasAreRecordedOrRefusedWithAMessage) {
  const std::uint32_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const std::array<float, 8> floats{0.0f, -0.0f, 1.0f, -1.0f, 1e30f, 1e-30f, kNaN, -1e38f};
  constexpr std::size_t kFirst = offsetof(AlcoveSettings, radius);
  constexpr std::size_t kCount = (offsetof(AlcoveSettings, intensity) + 4 - kFirst) / 4;
  constexpr std::size_t kFirstAdvanced = offsetof(AlcoveAdvancedSettings, estimator);
  constexpr std::size_t kAdvancedCount = (sizeof(AlcoveAdvancedSettings) - kFirstAdvanced) / 4;
  int refused = 0;
  for (int i = 0; i < 60; ++i) {
    AlcoveSettings settings{.struct_size = sizeof settings};
    ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, 0.5f, &settings), ALCOVE_SUCCESS);
    AlcoveAdvancedSettings advanced{.struct_size = sizeof advanced};
    ASSERT_EQ(alcoveGetAdvancedSettings(ALCOVE_QUALITY_LOW, &advanced), ALCOVE_SUCCESS);
    settings.advanced = &advanced;
    AlcoveView changed = view();
    changed.settings = &settings;
    const std::uint32_t small = random() % 8;
    const float number = floats.at(random() % floats.size());
    char* const field =
        random() % 2 == 0
            ? reinterpret_cast<char*>(&settings) + kFirst + 4 * (random() % kCount)
            : reinterpret_cast<char*>(&advanced) + kFirstAdvanced + 4 * (random() % kAdvancedCount);
    if (random() % 2 == 0)
      std::memcpy(field, &small, 4);
    else if (random() % 2 == 0)
      std::memcpy(field, &number, 4);
    else
      changed.camera.clip_from_view[random() % 16] = number;
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &changed};
    engine().submit(0, [&](VkCommandBuffer commands) {
      const AlcoveResult result = alcoveRecordFrame(context(), commands, &frame);
      if (result != ALCOVE_SUCCESS) {
        ++refused;
        EXPECT_EQ(result, ALCOVE_ERROR_INVALID_INPUT) << alcoveGetMessage(context());
        EXPECT_PRED1(is_a_sentence, alcoveGetMessage(context()));
      }
    });
  }
  EXPECT_GT(refused, 0);
  engine().wait();
}

}  // namespace
}  // namespace alcove::passes
