// Holds the table of what frames are refused for, each rule once. Tests that invalid input gives an
// error value and a message of one sentence, that nothing is recorded then, and that the next frame
// is the same as without the invalid call.
#include <gmock/gmock.h>

#include <array>
#include <cctype>
#include <cstring>
#include <string>
#include <variant>

#include "c_interface_fixture.h"
#include "maths/random_input.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kMost = ~0u;

bool is_a_sentence(const std::string& text) {
  return !text.empty() && text.back() == '.' && std::isupper(static_cast<unsigned char>(text[0]));
}

// Sets an enum of the C interface to a number that need not be one of its enumerators.
template <typename Enum>
void set_number(Enum& value, std::uint32_t number) {
  std::memcpy(&value, &number, sizeof number);
}

// A frame of the view number 0, which tests make invalid.
struct Draft {
  AlcoveFrame frame;
  std::array<AlcoveView, 9> views;
  AlcoveSettings settings;
};

struct Areas {
  AlcoveArea read, written;
  std::uint32_t output_x = 0, output_y = 0;
};

// A change that makes a frame invalid, and a part of the message.
struct Refusal {
  const char* message;
  std::variant<Areas, void (*)(AlcoveFrame&), void (*)(AlcoveView&), void (*)(AlcoveSettings&),
               void (*)(Draft&)>
      change;
};

class CRefusals : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    if (HasFatalFailure()) return;
    from_ = draw_view(16, 12, groove(0.8));
    request_all_outputs(from_);
    view_ = create_view(from_);
    view_.images[ALCOVE_IMAGE_MASK] =
        engine().make_filled(VK_FORMAT_R8_UINT, 16, 12, Bytes(16UL * 12));  // without effect
    view_.info.not_receiving = 1;
  }

  // Expects the same error from alcovePrepareFrame and alcoveRecordFrame.
  void expect_refused(const Refusal& refusal) {
    SCOPED_TRACE(refusal.message);
    Draft draft{.settings = *view_.info.settings};
    draft.views.fill(view_);
    for (std::uint32_t i = 0; i < draft.views.size(); ++i) {
      draft.views.at(i).info.id = i;
      draft.views.at(i).info.settings = &draft.settings;
    }
    draft.frame = make_frame(std::span(draft.views).first(1), 1);
    std::visit(
        [&](auto change) {
          if constexpr (std::is_same_v<decltype(change), Areas>)
            set_areas(draft.views[0], change);
          else if constexpr (std::is_invocable_v<decltype(change), AlcoveFrame&>)
            change(draft.frame);
          else if constexpr (std::is_invocable_v<decltype(change), AlcoveView&>)
            change(draft.views[0]);
          else if constexpr (std::is_invocable_v<decltype(change), AlcoveSettings&>)
            change(draft.settings);
          else
            change(draft);
        },
        refusal.change);
    EXPECT_EQ(alcovePrepareFrame(&context(), &draft.frame), ALCOVE_ERROR_INVALID_INPUT);
    const std::string message = alcoveGetMessage(&context());
    EXPECT_THAT(message, HasSubstr(refusal.message));
    EXPECT_PRED1(is_a_sentence, message);
    EXPECT_EQ(record(context(), draft.frame), ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(message, alcoveGetMessage(&context()));
  }

  static void set_areas(AlcoveView& view, const Areas& areas) {
    view.info.read_area = areas.read;
    view.info.written_area = areas.written;
    view.info.output_x = areas.output_x;
    view.info.output_y = areas.output_y;
  }

  void expect_a_good_frame() {
    from_.reset = true;  // by C the view was never recorded before
    expect_equal(run_view(view_, 0), run_plainly(from_, 0));
  }

  AlcoveView& view() { return view_; }

 private:
  HostView from_;
  AlcoveView view_{};
};

TEST_F(CRefusals, InvalidFramesAreRefusedWithAMessageThatNamesTheMistake) {
  using F = AlcoveFrame;
  using V = AlcoveView;
  using S = AlcoveSettings;
  using D = Draft;
  const Refusal refusals[] = {
      {"AlcoveFrame::struct_size is 0", [](F& f) { f.struct_size = 0; }},
      {"slot is 2", [](F& f) { f.slot = 2; }},
      {"0 views", [](F& f) { f.view_count = 0; }},
      {"9 views", [](F& f) { f.view_count = 9; }},
      {"0 views", [](F& f) { f.views = nullptr; }},
      {"given twice", [](F& f) { f.view_count = 2; }},
      {"id 1",
       [](D& d) {
         d.frame.view_count = 2;
         d.views[0].info.id = d.views[1].info.id;
       }},
      {"AlcoveView::struct_size", [](V& v) { v.struct_size -= 1; }},

      {"no settings", [](V& v) { v.info.settings = nullptr; }},
      // The rules of each setting are in settings_test.cpp.
      {"'radius' is nan;", [](S& s) { s.radius = kNaN; }},
      {"'specular' is none, but there is an image", [](S& s) { set_number(s.specular, 0); }},

      // Cameras. In a row-major matrix the translation lies where this matrix has its last row.
      {"The view cannot be used: view_from_world",
       [](V& v) { v.info.camera.view_from_world[13] = kNaN; }},
      {"column-major", [](V& v) { v.info.camera.view_from_world[3] = 5.0f; }},
      {"The view cannot be used", [](V& v) { v.info.camera.clip_from_view[11] = 1.0f; }},

      // Images: size, format, usage and layout.
      {"no image of depth", [](V& v) { v.images[ALCOVE_IMAGE_DEPTH] = {}; }},
      {"depth is 0x12", [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].width = 0; }},
      {"depth", [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"depth", [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].format = VK_FORMAT_UNDEFINED; }},
      {"without contents",
       [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED; }},
      {"normals has 15x12", [](V& v) { v.images[ALCOVE_IMAGE_NORMALS].width = 15; }},
      {"normals has the format VK_FORMAT_R8G8B8A8_UNORM",
       [](V& v) { v.images[ALCOVE_IMAGE_NORMALS].format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"normals has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_NORMALS].format = VK_FORMAT_R16G16_SFLOAT; }},
      {"normal_encoding is 4", [](V& v) { set_number(v.info.normal_encoding, 4); }},
      {"motion vectors has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_MOTION].format = VK_FORMAT_R32G32_UINT; }},
      {"scale of motion vectors is 0", [](V& v) { v.info.motion_scale[0] = 1.0f; }},
      {"roughness has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_ROUGHNESS].format = VK_FORMAT_R8_UNORM; }},
      {"no image of back-face depth",
       [](D& d) {
         d.settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
         d.views[0].images[ALCOVE_IMAGE_BACK_DEPTH] = {};
       }},
      {"no image of second depth",
       [](D& d) {
         d.settings.depth_layers = 2;
         d.views[0].images[ALCOVE_IMAGE_SECOND_DEPTH] = {};
       }},
      {"albedo has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_ALBEDO].format = VK_FORMAT_BC7_SRGB_BLOCK; }},
      {"no image of albedo", [](V& v) { v.images[ALCOVE_IMAGE_ALBEDO] = {}; }},
      {"without VK_IMAGE_USAGE_SAMPLED_BIT", [](V& v) { v.images[ALCOVE_IMAGE_ALBEDO].usage = 0; }},
      {"visibility has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_VISIBILITY].format = VK_FORMAT_D32_SFLOAT; }},
      // The multi-bounce pass samples it.
      {"visibility of view 0' with usage SAMPLED",
       [](V& v) { v.images[ALCOVE_IMAGE_VISIBILITY].usage = VK_IMAGE_USAGE_STORAGE_BIT; }},
      {"bent normals has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_BENT_NORMAL].format = VK_FORMAT_R8G8B8A8_UNORM; }},
      {"without VK_IMAGE_USAGE_STORAGE_BIT",
       [](V& v) { v.images[ALCOVE_IMAGE_BENT_NORMAL].usage = VK_IMAGE_USAGE_SAMPLED_BIT; }},
      {"specular occlusion is 1x1",
       [](V& v) {
         v.images[ALCOVE_IMAGE_SPECULAR].width = v.images[ALCOVE_IMAGE_SPECULAR].height = 1;
       }},
      {"no layout to be left in",
       [](V& v) {
         v.images[ALCOVE_IMAGE_SPECULAR].final_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
       }},
      {"multi-bounce has the format VK_FORMAT",
       [](V& v) { v.images[ALCOVE_IMAGE_MULTI_BOUNCE].format = VK_FORMAT_R32_SFLOAT; }},
      {"given twice",
       [](V& v) { v.images[ALCOVE_IMAGE_SPECULAR] = v.images[ALCOVE_IMAGE_VISIBILITY]; }},
      {"given twice",
       [](V& v) {
         v.images[ALCOVE_IMAGE_MOTION] = v.images[ALCOVE_IMAGE_ROUGHNESS];
         v.images[ALCOVE_IMAGE_MOTION].final_state.stages = VK_PIPELINE_STAGE_2_COPY_BIT;
       }},
      {"no image to write to",
       [](V& v) {
         v.images[ALCOVE_IMAGE_VISIBILITY] = v.images[ALCOVE_IMAGE_BENT_NORMAL] =
             v.images[ALCOVE_IMAGE_SPECULAR] = v.images[ALCOVE_IMAGE_MULTI_BOUNCE] = {};
       }},

      // Samples.
      {"View 0: The image of normals has 4 samples a pixel; resolve it first, depths and normals "
       "to sample 0.",
       [](V& v) { v.images[ALCOVE_IMAGE_NORMALS].samples = 4; }},
      {"The image of depth has 3 samples a pixel; it must be a power of two",
       [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].samples = 3; }},
      {"The image of depth has 128 samples a pixel",
       [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].samples = 128; }},
      {"64", [](V& v) { v.images[ALCOVE_IMAGE_DEPTH].samples = 64; }},  // more than any device has

      // Masks.
      {"must be VK_FORMAT_R8_UNORM or VK_FORMAT_R8_UINT",
       [](V& v) { v.images[ALCOVE_IMAGE_MASK].format = VK_FORMAT_R16_UINT; }},
      {"give at least one bit", [](V& v) { v.info.not_receiving = 0; }},
      {"values up to 255", [](V& v) { v.info.not_occluding = 256; }},

      // Dynamic resolution.
      {"it must be within 15x12",
       [](V& v) {
         v.info.largest_width = 15;
         v.info.largest_height = 12;
       }},

      // Areas.
      {"read has 16x12 pixels at (1, 0); it must lie within", Areas{{1, 0, 16, 12}}},
      {"it must lie within depth's 16x12", Areas{{kMost, 0, 2, 12}}},
      {"read has 0x5 pixels at (2, 2); each side must be at least 1", Areas{{2, 2, 0, 5}}},
      {"it must lie within the area that is read", Areas{{2, 2, 10, 9}, {1, 2, 4, 4}}},
      {"it must lie within the area that is read", Areas{{2, 2, 10, 9}, {3, 3, kMost, kMost}}},
      {"it needs room for 10x9 pixels at (12, 0)", Areas{{2, 2, 10, 9}, {}, 12, 0}},
      {"View 2: The image of visibility is written by view 0 in 8x12 pixels at (0, 0) and by this "
       "view in 8x12 pixels at (7, 0)",
       [](D& d) {
         set_areas(d.views[0], {{0, 0, 8, 12}});
         set_areas(d.views[1], {{0, 0, 8, 12}, {}, 8, 0});
         set_areas(d.views[2], {{8, 0, 8, 12}, {}, 7, 0});
         d.frame.view_count = 3;
       }},
      {"and by this view in 16x12 pixels at (0, 0)",
       [](D& d) {
         set_areas(d.views[1], {{0, 0, 16, 12}});
         d.frame.view_count = 2;
       }},
  };
  for (const Refusal& refusal : refusals) expect_refused(refusal);
  expect_a_good_frame();
}

TEST_F(CRefusals, PreviousCameraIsCheckedOnlyIfTheViewHasHistoryContents) {
  view().info.previous_camera = {};
  const AlcoveFrame frame = make_frame({&view(), 1}, 0);
  EXPECT_EQ(alcovePrepareFrame(&context(), &frame), ALCOVE_SUCCESS) << alcoveGetMessage(&context());
  run_frame(context(), {&view(), 1}, 0);  // the view's first frame
  EXPECT_EQ(record(context(), frame), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(alcoveGetMessage(&context()), HasSubstr("The previous view cannot be used"));
  EXPECT_THAT(alcoveGetMessage(&context()), HasSubstr("reset_history"));
  view().info.previous_camera = {};
  view().info.reset_history = VK_TRUE;
  expect_a_good_frame();
}

TEST_F(CRefusals, PreviousCameraAndImageSizesAreIgnoredIfHistoryIsOff) {
  AlcoveSettings settings = *view().info.settings;
  settings.history_frames = 0;
  view().info.settings = &settings;
  const HostOutputs expected = run_view(view(), 0);
  view().info.previous_camera = {};
  view().info.previous_width = view().info.previous_height = 1000;
  view().info.largest_width = 1;
  expect_equal(run_view(view(), 0), expected);
}

TEST_F(CRefusals, NullPointersAndUnknownSizesOfStructsAreErrors) {
  AlcoveContext* const context = &this->context();
  const AlcoveResult error = ALCOVE_ERROR_INVALID_INPUT;
  AlcoveFrame frame{.struct_size = sizeof frame};
  EXPECT_EQ(alcoveRecordFrame(context, VK_NULL_HANDLE, &frame), error);
  EXPECT_THAT(alcoveGetMessage(context), HasSubstr("command buffer"));
  EXPECT_EQ(alcoveRecordFrame(nullptr, VK_NULL_HANDLE, &frame), error);
  engine().submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(alcoveRecordFrame(context, commands, nullptr), error);
  });
  EXPECT_EQ(alcovePrepareFrame(nullptr, &frame), error);
  EXPECT_EQ(alcovePrepareFrame(context, nullptr), error);
  EXPECT_THAT(alcoveGetMessage(context), HasSubstr("no AlcoveFrame"));
  EXPECT_EQ(alcoveGetMemory(context, nullptr), error);
  EXPECT_EQ(alcoveGetMemory(nullptr, nullptr), error);
  AlcoveMemory memory{};
  EXPECT_EQ(alcoveGetMemory(context, &memory), error);
  EXPECT_THAT(alcoveGetMessage(context), HasSubstr("AlcoveMemory::struct_size"));
  std::uint32_t count = 0;
  EXPECT_EQ(alcoveGetTimings(context, 0, nullptr, nullptr), error);
  EXPECT_EQ(alcoveGetTimings(context, 2, &count, nullptr), error);
  EXPECT_EQ(alcoveGetTimings(nullptr, 0, &count, nullptr), error);
  EXPECT_EQ(alcovePrintPlan(nullptr, nullptr, 0), 0u);
  EXPECT_EQ(alcoveDiagnose(nullptr, nullptr, 0), 0u);
  EXPECT_EQ(alcoveDropView(nullptr, 0), error);
  EXPECT_EQ(alcoveForgetImage(nullptr, VK_NULL_HANDLE), error);
  EXPECT_EQ(alcoveForgetImage(context, VK_NULL_HANDLE), ALCOVE_SUCCESS);
  AlcoveView empty{};
  EXPECT_EQ(alcoveSetStillFrame(0, nullptr), error);
  EXPECT_EQ(alcoveSetStillFrame(0, &empty), error);
  EXPECT_STRNE(alcoveGetMessage(nullptr), "");
  alcoveDestroyContext(nullptr);
  expect_a_good_frame();
}

TEST_F(CRefusals, InvalidCreationInfoOfAContextIsReported) {
  struct Case {
    const char* message;
    void (*change)(AlcoveContextInfo&);
  };
  using I = AlcoveContextInfo;
  const Case cases[] = {
      {"struct_size", [](I& i) { i.struct_size = 0; }},
      {"instance is null", [](I& i) { i.instance = VK_NULL_HANDLE; }},
      {"physical_device is null", [](I& i) { i.physical_device = VK_NULL_HANDLE; }},
      {"device is null", [](I& i) { i.device = VK_NULL_HANDLE; }},
      {"get_instance_proc_addr is null", [](I& i) { i.get_instance_proc_addr = nullptr; }},
      {"frames_in_flight is 0", [](I& i) { i.frames_in_flight = 0; }},
      {"frames_in_flight is 9", [](I& i) { i.frames_in_flight = 9; }},
      {"queue_family is 4294967295", [](I& i) { i.queue_family = kMost; }},
      {"only one of allocate and free",
       [](I& i) { i.memory_functions.free = [](void*, const AlcoveMemoryRange*) {}; }},
  };
  char message[ALCOVE_MAX_MESSAGE];
  for (const Case& bad : cases) {
    AlcoveContextInfo info = engine().context_info();
    bad.change(info);
    AlcoveContext* handle = &context();
    EXPECT_EQ(alcoveCreateContext(&info, &handle, message), ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(handle, nullptr);
    EXPECT_THAT(message, HasSubstr(bad.message));
    EXPECT_PRED1(is_a_sentence, message);
  }
  AlcoveContext* handle = nullptr;
  EXPECT_EQ(alcoveCreateContext(nullptr, &handle, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  const AlcoveContextInfo info = engine().context_info();
  EXPECT_EQ(alcoveCreateContext(&info, nullptr, message), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_PRED1(is_a_sentence, message);
}

// Random numbers in settings and cameras never crash: either the frame is recorded, or it is
// refused with a sentence.
TEST_F(CRefusals, FramesWithRandomSettingsAndCamerasAreRecordedOrRefusedWithAMessage) {
  maths_test::RandomInput random;
  const std::array<float, 8> floats{0.0f, -0.0f, 1.0f, -1.0f, 1e30f, 1e-30f, kNaN, -1e38f};
  constexpr std::size_t kFirst = offsetof(AlcoveSettings, radius);
  constexpr std::size_t kCount = (offsetof(AlcoveSettings, intensity) + 4 - kFirst) / 4;
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    AlcoveSettings settings = get_settings(ALCOVE_QUALITY_LOW, 0.5f);
    AlcoveView changed = view();
    changed.info.settings = &settings;
    const std::uint32_t small = random.bits() % 8;
    const float number = floats.at(random.bits() % floats.size());
    char* const field = reinterpret_cast<char*>(&settings) + kFirst + 4 * (random.bits() % kCount);
    if (random.bits() % 2 == 0)
      std::memcpy(field, &small, 4);
    else if (random.bits() % 2 == 0)
      std::memcpy(field, &number, 4);
    else
      changed.info.camera.clip_from_view[random.bits() % 16] = number;
    const AlcoveResult result = record(context(), make_frame({&changed, 1}, 0));
    if (result != ALCOVE_SUCCESS) {
      ++refused;
      EXPECT_EQ(result, ALCOVE_ERROR_INVALID_INPUT) << alcoveGetMessage(&context());
      EXPECT_PRED1(is_a_sentence, alcoveGetMessage(&context()));
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace alcove::passes
