// Tests the passes, the memory and the timings of frames by the C interface. Outputs that are not
// requested must cost nothing, a frame like the one before must allocate nothing, and dropped views
// must have no memory.
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

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

// Returns a view with the least work.
HostView draw_least() {
  HostView view = draw_view(32, 24, groove(0.8));
  view.settings.estimator = Estimator::horizons;
  view.settings.steps = 4;
  view.settings.history_frames = 0;
  view.motion = {};
  return view;
}

class CPlan : public CInterface {
 protected:
  // Runs a frame and returns its memory.
  AlcoveMemory run_memory(AlcoveContext& context, const HostView& view) {
    (void)run_by_c(context, {&view, 1}, index_++);
    return get_memory(context);
  }

 private:
  std::uint32_t index_ = 0;
};

TEST_F(CPlan, SingleRequestedOutputNeedsNoPassOrMemoryOfOtherOutputs) {
  const Context context = create_context();
  const HostView visibility = draw_least();
  const VkDeviceSize bytes = run_memory(*context, visibility).transients_unshared;
  EXPECT_THAT(print_plan(*context), HasSubstr("visibility of view 0"));
  for (const char* absent : {"bent", "specular", "multi-bounce", "normals from depth"})
    EXPECT_THAT(print_plan(*context), Not(HasSubstr(absent)));

  HostView bent = draw_least();
  bent.settings.visibility = false;
  bent.settings.bent_normal = true;
  EXPECT_GT(run_memory(*context, bent).transients_unshared, bytes) << "of the search";
  EXPECT_THAT(print_plan(*context), HasSubstr("bent normals of view 0"));
  for (const char* absent : {"visibility", "specular"})
    EXPECT_THAT(print_plan(*context), Not(HasSubstr(absent)));

  // Multi-bounce is made from visibility. Because the engine gives no image for visibility, the
  // library makes a transient, which takes memory.
  HostView multi_bounce = draw_least();
  multi_bounce.settings.visibility = false;
  multi_bounce.multi_bounce = true;
  EXPECT_GT(run_memory(*context, multi_bounce).transients_unshared, bytes);
  EXPECT_THAT(print_plan(*context), Not(HasSubstr("visibility of view 0")));
  multi_bounce.settings.visibility = true;
  EXPECT_EQ(run_memory(*context, multi_bounce).transients_unshared, bytes);
}

// If only a part of an output image is written, the library must not begin with a transition from
// VK_IMAGE_LAYOUT_UNDEFINED, because the driver may then discard the other pixels.
TEST_F(CPlan, OutputImageWithContentsIsNotDiscardedByItsFirstLayoutTransition) {
  for (const Specular specular : {Specular::slices, Specular::table}) {
    HostView from = draw_least();
    request_all_outputs(from);
    from.settings.specular = specular;
    AlcoveView view = create_view(from);
    for (const bool has_contents : {false, true}) {
      for (const Output& each : kOutputs) {
        (view.*each.image).initial_state = kResting;
        if (!has_contents) (view.*each.image).initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
      }
      run_frame(context(), {&view, 1}, 0);
      const std::string plan = print_plan(context());
      for (const std::string name :
           {"visibility", "bent normals", "specular occlusion", "multi-bounce"}) {
        const std::string discarded = name + " of view 0 undefined ->";
        const std::string kept = name + " of view 0 shader read -> general";
        EXPECT_THAT(plan, HasSubstr(has_contents ? kept : discarded));
        EXPECT_THAT(plan, Not(HasSubstr(has_contents ? discarded : kept)));
      }
    }
  }
}

TEST_F(CPlan, HistoryTakesMemoryOnlyForViewsThatHaveOne) {
  const Context context = create_context();
  HostView view = draw_least();
  EXPECT_EQ(run_memory(*context, view).history, 0u);
  view.settings.history_frames = 8;
  const VkDeviceSize history = run_memory(*context, view).history;
  EXPECT_GT(history, 0u);
  view.id = 1;
  EXPECT_EQ(run_memory(*context, view).history, 2 * history);
  view.settings.history_frames = 0;
  (void)run_memory(*context, view);
  EXPECT_EQ(run_memory(*context, view).history, history) << "of the other view";
  EXPECT_EQ(alcoveDropView(context.get(), 0), ALCOVE_SUCCESS);
  EXPECT_EQ(alcoveDropView(context.get(), 99), ALCOVE_SUCCESS) << "never recorded";
  EXPECT_EQ(run_memory(*context, view).history, 0u);
  view.settings.history_frames = 8;
  EXPECT_EQ(run_memory(*context, view).history, history);

  // A view that is recorded again after it was dropped begins a new history.
  EXPECT_EQ(alcoveDropView(context.get(), view.id), ALCOVE_SUCCESS);
  const Results again = run_by_c(*context, {&view, 1}, 7)[0];
  view.id = 77;
  expect_equal(again, run_by_c(*context, {&view, 1}, 7)[0]);
}

TEST_F(CPlan, FrameThatFailedToRecordHasNoMemoryReportAndNoPlan) {
  EXPECT_GT(run_memory(context(), draw_least()).allocated, 0u);
  EXPECT_NE(print_plan(context()), "");
  EXPECT_EQ(record(context(), make_frame({}, 0)), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(get_memory(context()).allocated, 0u);
  EXPECT_EQ(print_plan(context()), "");
}

TEST_F(CPlan, EstimatedMemoryIsWithinFivePercentOfThatOfRecordedFrames) {
  constexpr std::uint32_t kWidth = 256, kHeight = 128;
  struct Case {
    const char* name;
    std::uint32_t outputs;
    Specular specular;
    std::uint32_t inputs;
    Quality quality;
    bool half_resolution = false;
    bool history = true;
  };
  constexpr std::uint32_t kVisibility = ALCOVE_OUTPUT_VISIBILITY;
  constexpr std::uint32_t kBent = kVisibility | ALCOVE_OUTPUT_BENT_NORMAL;
  constexpr std::uint32_t kAll = kBent | ALCOVE_OUTPUT_SPECULAR;
  constexpr std::uint32_t kNormals = ALCOVE_INPUT_NORMALS;
  constexpr std::uint32_t kMask = ALCOVE_INPUT_MASK, kSamples = ALCOVE_INPUT_SAMPLES;
  constexpr Specular kNone = Specular::none, kSlices = Specular::slices;
  for (const Case& wanted :
       {Case{"visibility", kVisibility, kNone, kNormals, Quality::medium},
        Case{"from depth", kVisibility, kNone, 0, Quality::low},
        Case{"bent", kBent, kNone, kNormals, Quality::medium},
        Case{"all", kAll, kSlices, kNormals, Quality::low},
        Case{"by table", ALCOVE_OUTPUT_SPECULAR, Specular::table, kNormals, Quality::low},
        Case{"half resolution", kAll, kSlices, kNormals, Quality::medium, true},
        Case{"console", kVisibility, kNone, kNormals, Quality::console, true},
        Case{"no history", kVisibility, kNone, kNormals, Quality::reference, false, false},
        Case{"half, no history", kAll, kSlices, kNormals, Quality::medium, true, false},
        Case{"mask", kVisibility, kNone, kNormals | kMask, Quality::low},
        Case{"samples", kVisibility, kNone, kSamples, Quality::low},
        Case{"mask, samples, table", ALCOVE_OUTPUT_SPECULAR, Specular::table, kMask | kSamples,
             Quality::low}}) {
    SCOPED_TRACE(wanted.name);
    HostView from = draw_view(kWidth, kHeight, {tilted_plane(20.0, 4.0)});
    from.settings = quality_settings(wanted.quality, 0.5f);
    from.settings.half_resolution = wanted.half_resolution;
    from.settings.history_frames = wanted.history ? from.settings.history_frames : 0;
    from.settings.slices = 1;
    from.settings.steps = 4;
    from.settings.visibility = (wanted.outputs & kVisibility) != 0;
    from.settings.bent_normal = (wanted.outputs & ALCOVE_OUTPUT_BENT_NORMAL) != 0;
    from.settings.specular = wanted.specular;
    from.motion = from.back_depth_ndc = from.second_depth_ndc = {};
    if ((wanted.inputs & kNormals) == 0) from.normals = {};
    AlcoveView view = create_view(from);
    if ((wanted.inputs & kMask) != 0) {
      view.mask =
          engine().make_image(VK_FORMAT_R8_UINT, kWidth, kHeight, VK_IMAGE_USAGE_SAMPLED_BIT);
      view.not_occluding = 1;
    }
    if ((wanted.inputs & kSamples) != 0) {
      view.depth = engine().make_image(
          VK_FORMAT_D32_SFLOAT, kWidth, kHeight,
          VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 1,
          VK_SAMPLE_COUNT_4_BIT);
      view.depth.samples = 4;
    }
    run_frame(context(), {&view, 1}, 0);
    engine().wait();
    const AlcoveMemory found = get_memory(context());
    EXPECT_EQ(alcoveDropView(&context(), view.id), ALCOVE_SUCCESS);
    AlcoveMemory estimate{.struct_size = sizeof estimate};
    ASSERT_EQ(alcoveEstimateMemory(view.settings, kWidth, kHeight, wanted.outputs, wanted.inputs,
                                   &estimate),
              ALCOVE_SUCCESS);
    const auto about = [](std::uint64_t bytes) { return static_cast<double>(bytes); };
    EXPECT_NEAR(about(found.history), about(estimate.history), 0.05 * about(estimate.history));
    EXPECT_NEAR(about(found.transients_unshared), about(estimate.transients_unshared),
                0.05 * about(estimate.transients_unshared));
    EXPECT_LE(found.transients, estimate.transients + estimate.transients / 20);
  }
}

TEST(CMemory, InvalidArgumentsOfTheMemoryEstimateAreErrors) {
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 1.0f);
  AlcoveMemory memory{.struct_size = sizeof memory};
  const auto estimate = [&](std::uint32_t width, std::uint32_t height, std::uint32_t outputs,
                            std::uint32_t inputs) {
    return alcoveEstimateMemory(&settings, width, height, outputs, inputs, &memory);
  };
  EXPECT_EQ(estimate(16, 16, 1, 1), ALCOVE_SUCCESS);
  EXPECT_EQ(estimate(0, 16, 1, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(estimate(16, 70000, 1, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(estimate(16, 16, 0, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(estimate(16, 16, 16, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(estimate(16, 16, 1, 8), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(nullptr, 16, 16, 1, 1, &memory), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(&settings, 16, 16, 1, 1, nullptr), ALCOVE_ERROR_INVALID_INPUT);
}

TEST_F(CPlan, TimingsListThePassesOfEachViewOfAFinishedFrame) {
  const Context context = create_context();
  std::uint32_t count = 99;
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
  EXPECT_EQ(count, 0u) << "before there is a frame";
  std::array<HostView, 3> views{draw_least(), draw_least(), draw_least()};
  views[0].id = 4000000000u;
  views[1].id = 7;
  views[1].normals = {};  // needs no further pass
  (void)run_by_c(*context, views, 0);
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
  EXPECT_EQ(count, 6u);
  std::array<AlcoveTiming, 16> timings{};
  count = timings.size();
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, timings.data()), ALCOVE_SUCCESS);
  ASSERT_EQ(count, 6u);
  std::map<std::uint32_t, std::multiset<std::string>> passes;
  for (const AlcoveTiming& timing : std::span(timings).first(count)) {
    passes[timing.view].insert(timing.pass);
    EXPECT_GE(timing.milliseconds, 0.0);
  }
  for (const HostView& view : views)
    EXPECT_EQ(passes[view.id], (std::multiset<std::string>{"gtao", "reconstruct"}));
  count = 1;
  EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, timings.data()), ALCOVE_SUCCESS);
  EXPECT_EQ(count, 1u);
}

std::string print_settings(const AlcoveSettings& settings) {
  return print(
      [&](char* text, std::size_t size) { return alcovePrintSettings(&settings, text, size); });
}

TEST(CSettings, SettingsOfEveryQualityCanBeFilledInAndPrinted) {
  for (int quality = ALCOVE_QUALITY_CONSOLE; quality <= ALCOVE_QUALITY_REFERENCE; ++quality) {
    const AlcoveSettings settings = get_settings(static_cast<AlcoveQuality>(quality), 2.5f);
    const std::string text = print_settings(settings);
    EXPECT_THAT(text, HasSubstr("radius = 2.5\n"));
    EXPECT_THAT(text, HasSubstr("specular = slices\n"));
    EXPECT_EQ(std::ranges::count(text, '\n'), 19);
    char little[8];
    EXPECT_EQ(alcovePrintSettings(&settings, little, sizeof little), text.size());
    EXPECT_EQ(std::string(little), text.substr(0, 7));
  }
  EXPECT_EQ(alcoveGetVersion(), static_cast<std::uint32_t>(ALCOVE_VERSION));
}

// Each printed value reads back as the same number.
TEST(CSettings, SettingValuesArePrintedShortAndExactInEveryLocale) {
  const CommaLocale comma;
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 0.15f);
  settings.thickness = 0.12345678f;
  settings.hidden_occlusion = 1e-7f;
  settings.power = 1.5f;
  const std::string text = print_settings(settings);
  EXPECT_THAT(text, testing::StartsWith("radius = 0.15\ntile_size = 4\n"));
  for (const char* line :
       {"\nthickness = 0.12345678\n", "\nhidden_occlusion = 1e-07\n", "\npower = 1.5\n"})
    EXPECT_THAT(text, HasSubstr(line));
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
  AlcoveContext* handle = nullptr;
  ASSERT_EQ(alcoveCreateContext(&info, &handle, nullptr), ALCOVE_SUCCESS);
  const Context context(handle);
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
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
  AlcoveFrame frame = make_frame(views, 0);
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
