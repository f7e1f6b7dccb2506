// Tests the passes and the memory of frames by the C interface. Outputs that are not requested must
// cost nothing, a frame like the one before must allocate nothing, and dropped views must have no
// memory.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "c_interface_fixture.h"
#include "comma_locale.h"
#include "framegraph/allocation_counter.h"
#include "framegraph/failing_device.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

class CPlan : public CInterface {
 protected:
  GivenView least() {
    GivenView given = given_view(test_views()[2], 32, 24, groove(0.8));
    given.settings.advanced.estimator = Estimator::horizons;
    given.settings.steps = 4;
    given.settings.history_frames = 0;
    given.settings.visibility = false;
    given.motion = {};
    return given;
  }
  AlcoveMemory memory_of_frame(const Context& context, const GivenView& given) {
    (void)run_by_c(*context, {&given, 1}, index_++);
    return memory_of(*context);
  }

 private:
  std::uint32_t index_ = 0;
};

TEST_F(CPlan, SingleRequestedOutputNeedsNoPassOrMemoryOfOtherOutputs) {
  const Context context = create_context();
  GivenView visibility = least();
  visibility.settings.visibility = true;
  const VkDeviceSize bytes = memory_of_frame(context, visibility).transients_unshared;
  std::string plan = plan_of(*context);
  EXPECT_THAT(plan, HasSubstr("visibility of view 0"));
  for (const char* absent : {"bent", "specular", "multi-bounce", "normals from depth"})
    EXPECT_THAT(plan, Not(HasSubstr(absent)));

  GivenView bent = least();
  bent.settings.bent_normal = true;
  EXPECT_GT(memory_of_frame(context, bent).transients_unshared, bytes) << "of the search";
  plan = plan_of(*context);
  EXPECT_THAT(plan, HasSubstr("bent normals of view 0"));
  EXPECT_THAT(plan, Not(HasSubstr("visibility")));
  EXPECT_THAT(plan, Not(HasSubstr("specular")));

  GivenView specular = least();
  specular.settings.specular = Specular::slices;
  EXPECT_GT(memory_of_frame(context, specular).transients_unshared, bytes) << "of the search";
  plan = plan_of(*context);
  EXPECT_THAT(plan, HasSubstr("specular occlusion of view 0"));
  EXPECT_THAT(plan, Not(HasSubstr("visibility")));
  EXPECT_THAT(plan, Not(HasSubstr("bent")));

  // Multi-bounce is made from visibility. Because the engine gives no image for visibility, the
  // library makes a transient, which takes memory.
  GivenView multi_bounce = least();
  multi_bounce.multi_bounce = true;
  EXPECT_GT(memory_of_frame(context, multi_bounce).transients_unshared, bytes);
  EXPECT_THAT(plan_of(*context), Not(HasSubstr("visibility of view 0")));
  multi_bounce.settings.visibility = true;
  EXPECT_EQ(memory_of_frame(context, multi_bounce).transients_unshared, bytes);
}

// If only a part of an output image is written, the library must not begin with a transition from
// VK_IMAGE_LAYOUT_UNDEFINED, because the driver may then discard the other pixels.
TEST_F(CPlan, OutputImageWithContentsIsNotDiscardedByItsFirstLayoutTransition) {
  const Context context = create_context();
  for (const Specular specular : {Specular::slices, Specular::table}) {
    GivenView given = least();
    given.settings.visibility = given.settings.bent_normal = given.multi_bounce = true;
    given.settings.specular = specular;
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    for (const bool has_contents : {false, true}) {
      for (AlcoveImage* image :
           {&view.visibility, &view.bent_normal, &view.specular, &view.multi_bounce}) {
        image->initial_state = kResting;
        image->initial_state.layout = has_contents ? kResting.layout : VK_IMAGE_LAYOUT_UNDEFINED;
      }
      run_frame(*context, {&view, 1}, 0);
      engine().wait();
      const std::string plan = plan_of(*context);
      for (const std::string name :
           {"visibility", "bent normals", "specular occlusion", "multi-bounce"}) {
        const auto discarded = HasSubstr(name + " of view 0 undefined ->");
        if (has_contents) {
          EXPECT_THAT(plan, Not(discarded));
          EXPECT_THAT(plan, HasSubstr(name + " of view 0 shader read -> general"));
        } else {
          EXPECT_THAT(plan, discarded);
        }
      }
    }
  }
}

TEST_F(CPlan, HistoryTakesMemoryOnlyForViewsInWhichHistoryIsOn) {
  const Context context = create_context();
  GivenView given = least();
  given.settings.bent_normal = true;
  EXPECT_EQ(memory_of_frame(context, given).history, 0u);
  given.settings.history_frames = 8;
  const VkDeviceSize with_bent = memory_of_frame(context, given).history;
  EXPECT_GT(with_bent, 0u);
  given.id = 1;
  EXPECT_EQ(memory_of_frame(context, given).history, 2 * with_bent);

  given.settings.visibility = true;
  given.settings.bent_normal = false;
  (void)memory_of_frame(context, given);
  EXPECT_LT(memory_of_frame(context, given).history, 2 * with_bent) << "an output less";
  given.settings.history_frames = 0;
  (void)memory_of_frame(context, given);
  EXPECT_EQ(memory_of_frame(context, given).history, with_bent) << "of the other view";
  EXPECT_EQ(alcoveDropView(context.get(), 0), ALCOVE_SUCCESS);
  EXPECT_EQ(alcoveDropView(context.get(), 99), ALCOVE_SUCCESS) << "never recorded";
  const AlcoveMemory dropped = memory_of_frame(context, given);
  EXPECT_EQ(dropped.history, 0u);
  // A view with the dropped id, or with a new one, begins a new history.
  for (const std::uint32_t id : {0u, 5u}) {
    given.id = id;
    given.settings.history_frames = 8;
    EXPECT_GT(memory_of_frame(context, given).history, 0u);
  }
}

TEST_F(CPlan, FrameThatFailedToRecordHasNoMemoryReportAndNoPlan) {
  const Context context = create_context();
  GivenView given = least();
  given.settings.visibility = true;
  for (const bool is_null : {true, false}) {
    EXPECT_GT(memory_of_frame(context, given).allocated, 0u);
    AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 0};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, is_null ? nullptr : &frame),
                ALCOVE_ERROR_INVALID_INPUT);
    });
    EXPECT_EQ(memory_of(*context).allocated, 0u);
    EXPECT_EQ(plan_of(*context), "");
  }
  engine().wait();
}

TEST_F(CPlan, ViewRecordedAgainAfterItWasDroppedBeginsANewHistory) {
  const Context context = create_context();
  GivenView given = least();
  given.settings.visibility = true;
  given.settings.history_frames = 8;
  for (std::uint32_t i = 0; i < 3; ++i) (void)run_by_c(*context, {&given, 1}, i);
  EXPECT_EQ(alcoveDropView(context.get(), given.id), ALCOVE_SUCCESS);
  const Results again = run_by_c(*context, {&given, 1}, 3)[0];
  given.id = 77;
  expect_equal(again, run_by_c(*context, {&given, 1}, 3)[0]);
}

TEST_F(CPlan, TimingsListThePassesOfAFinishedFrame) {
  const Context context = create_context();
  std::uint32_t count = 99;
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
  EXPECT_EQ(count, 0u) << "before there is a frame";
  GivenView given = least();
  given.settings.visibility = true;
  (void)run_by_c(*context, {&given, 1}, 0);
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
  ASSERT_EQ(count, 2u);
  std::array<AlcoveTiming, 5> timings{};
  count = timings.size();
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, timings.data()), ALCOVE_SUCCESS);
  ASSERT_EQ(count, 2u);
  EXPECT_STREQ(timings[0].pass, "gtao");
  EXPECT_STREQ(timings[1].pass, "reconstruct");
  for (const AlcoveTiming& timing : timings) EXPECT_GE(timing.milliseconds, 0.0);
  count = 1;
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, timings.data()), ALCOVE_SUCCESS);
  EXPECT_EQ(count, 1u);
}

TEST_F(CPlan, TimingsNameTheViewOfEachPass) {
  const Context context = create_context();
  std::array<GivenView, 3> given;
  for (GivenView& view : given) {
    view = least();
    view.settings.visibility = true;
  }
  given[0].id = 4000000000u;
  given[1].id = 7;
  given[1].normals = {};  // needs no further pass
  given[2].id = 0;
  (void)run_by_c(*context, given, 0);
  std::array<AlcoveTiming, 16> timings{};
  std::uint32_t count = timings.size();
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, timings.data()), ALCOVE_SUCCESS);
  std::map<std::uint32_t, std::multiset<std::string>> passes;
  for (std::uint32_t i = 0; i < count; ++i) passes[timings.at(i).view].insert(timings.at(i).pass);
  const std::multiset<std::string> plain{"gtao", "reconstruct"};
  EXPECT_EQ(passes.size(), given.size());
  EXPECT_EQ(passes[given[0].id], plain);
  EXPECT_EQ(passes[given[1].id], plain);
  EXPECT_EQ(passes[given[2].id], plain);
}

TEST(CSettings, SettingsOfEveryQualityCanBeFilledInAndPrinted) {
  for (int quality = ALCOVE_QUALITY_CONSOLE; quality <= ALCOVE_QUALITY_REFERENCE; ++quality) {
    AlcoveSettings settings{.struct_size = sizeof(AlcoveSettings)};
    ASSERT_EQ(alcoveGetSettings(static_cast<AlcoveQuality>(quality), 2.5f, &settings),
              ALCOVE_SUCCESS);
    std::string text(alcovePrintSettings(&settings, nullptr, 0), '\0');
    EXPECT_EQ(alcovePrintSettings(&settings, text.data(), text.size() + 1), text.size());
    EXPECT_THAT(text, HasSubstr("radius = 2.5\n"));
    EXPECT_THAT(text, HasSubstr("specular = slices\n"));
    EXPECT_EQ(std::ranges::count(text, '\n'), 25);
    char little[8];
    EXPECT_EQ(alcovePrintSettings(&settings, little, sizeof little), text.size());
    EXPECT_EQ(std::string(little), text.substr(0, 7));
  }
  EXPECT_EQ(alcoveGetVersion(), static_cast<std::uint32_t>(ALCOVE_VERSION));
}

// Each printed value reads back as the same number.
TEST(CSettings, SettingValuesArePrintedShortAndExactInEveryLocale) {
  const CommaLocale comma;
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.15f, &settings), ALCOVE_SUCCESS);
  settings.thickness = 0.12345678f;
  settings.hidden_occlusion = 1e-7f;
  AlcoveAdvancedSettings advanced{.struct_size = sizeof advanced};
  ASSERT_EQ(alcoveGetAdvancedSettings(ALCOVE_QUALITY_MEDIUM, &advanced), ALCOVE_SUCCESS);
  advanced.filter_tolerance_px = 1234567.0f;
  settings.advanced = &advanced;
  std::string text(alcovePrintSettings(&settings, nullptr, 0), '\0');
  alcovePrintSettings(&settings, text.data(), text.size() + 1);
  EXPECT_THAT(text, testing::StartsWith("radius = 0.15\ntile_size = 4\n"));
  EXPECT_THAT(text, HasSubstr("\nthickness = 0.12345678\n"));
  EXPECT_THAT(text, HasSubstr("\nhidden_occlusion = 1e-07\n"));
  EXPECT_THAT(text, HasSubstr("\nfilter_tolerance_px = 1234567\n"));
}

// The parameter is the number of frames in flight. With an odd number, each frame slot uses both
// images of a history in turn. Each frame has two views with every output. The device has no
// validation layers, because the layers allocate memory.
class CSteadyFrame : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(FramesInFlight, CSteadyFrame, testing::Values(1u, 2u, 3u));

TEST_P(CSteadyFrame, SteadyFrameAllocatesNothingCreatesNoVulkanObjectAndUpdatesNoDescriptor) {
  const auto device = sample::VulkanDevice::create();
  ASSERT_TRUE(device) << device.error();
  Engine engine(**device);
  AlcoveContextInfo info = engine.context_info();
  info.frames_in_flight = GetParam();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  AlcoveContext* made = nullptr;
  ASSERT_EQ(alcoveCreateContext(&info, &made, nullptr), ALCOVE_SUCCESS);
  const Context context(made);
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings), ALCOVE_SUCCESS);
  settings.specular = ALCOVE_SPECULAR_TABLE;
  const auto make = [&](VkFormat format) {
    return engine.make_image(format, 24, 16,
                             VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  };
  std::array<AlcoveView, 2> views{};
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    AlcoveView& view = views.at(i);
    view = {.struct_size = sizeof view,
            .id = 4000000000u + i,
            .settings = &settings,
            .depth = make(VK_FORMAT_R32_SFLOAT),
            .normals = make(VK_FORMAT_R16G16B16A16_SFLOAT),
            .roughness = make(VK_FORMAT_R8_UNORM),
            .albedo = make(VK_FORMAT_R8G8B8A8_UNORM),
            .visibility = make(VK_FORMAT_R8_UNORM),
            .bent_normal = make(VK_FORMAT_R8G8B8A8_SNORM),
            .specular = make(VK_FORMAT_R8_UNORM),
            .multi_bounce = make(VK_FORMAT_R8G8B8A8_UNORM)};
    std::ranges::copy(test_views()[2].view.clip_from_view, view.camera.clip_from_view);
    std::ranges::copy(kIdentity, view.camera.view_from_world);
  }
  AlcoveFrame frame{.struct_size = sizeof frame, .view_count = views.size(), .views = views.data()};
  std::size_t steady = 0;
  int updates = 0;
  for (frame.index = 0; frame.index < 30; ++frame.index) {
    if (frame.index == 10) {
      framegraph::failing::fail_at(0);  // counts from here on
      updates = framegraph::failing::descriptor_updates();
      EXPECT_GT(updates, 0);
    }
    frame.slot = frame.index % GetParam();
    for (AlcoveView& view : views) {
      view.previous_camera = view.camera;
      view.camera.view_from_world[12] = std::sin(static_cast<float>(frame.index));
    }
    engine.wait();
    engine.submit(0, [&](VkCommandBuffer commands) {
      const std::size_t before = framegraph::allocations();
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS)
          << alcoveGetMessage(context.get());
      AlcoveMemory memory{.struct_size = sizeof memory};
      EXPECT_EQ(alcoveGetMemory(context.get(), &memory), ALCOVE_SUCCESS);
      std::uint32_t count = 0;
      EXPECT_EQ(alcoveGetTimings(context.get(), (frame.index + 1) % GetParam(), &count, nullptr),
                ALCOVE_SUCCESS);
      steady += frame.index < 10 ? 0 : framegraph::allocations() - before;
    });
  }
  engine.wait();
  EXPECT_EQ(steady, 0u);
  EXPECT_EQ(framegraph::failing::calls(), 0) << "objects of Vulkan were created";
  EXPECT_EQ(framegraph::failing::descriptor_updates() - updates, 0);
}

}  // namespace
}  // namespace alcove::passes
