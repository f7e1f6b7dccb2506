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

#include "alcove/alcove_work.h"
#include "c_interface_fixture.h"
#include "framegraph/allocation_counter.h"
#include "framegraph/failing_device.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

// Returns a view with the least work.
HostView draw_least() {
  HostView view = draw_view(32, 24, groove(0.8));
  view.settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  view.settings.steps = 4;
  view.settings.history_frames = 0;
  view.motion = {};
  return view;
}

class CPlan : public CInterface {
 protected:
  // Runs a frame and returns its memory.
  AlcoveMemory run_memory(AlcoveContext& context, const HostView& view) {
    (void)run_views(context, {&view, 1}, index_++);
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
  for (const AlcoveSpecular specular : {ALCOVE_SPECULAR_SLICES, ALCOVE_SPECULAR_TABLE}) {
    HostView from = draw_least();
    request_all_outputs(from);
    from.settings.specular = specular;
    AlcoveView view = create_view(from);
    for (const bool has_contents : {false, true}) {
      for (const OutputMember& each : kOutputs) {
        AlcoveState& state = view.images[each.role].initial_state;
        state = kResting;
        if (!has_contents) state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
      }
      run_frame(context(), {&view, 1}, 0);
      const std::string plan = print_plan(context());
      for (const std::string name :
           {"visibility", "bent normals", "specular occlusion", "multi-bounce"}) {
        const std::string from_undefined = name + " of view 0 undefined ->";
        const std::string from_shader_read = name + " of view 0 shader read -> general";
        EXPECT_THAT(plan, HasSubstr(has_contents ? from_shader_read : from_undefined));
        EXPECT_THAT(plan, Not(HasSubstr(has_contents ? from_undefined : from_shader_read)));
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
  const HostOutputs again = run_views(*context, {&view, 1}, 7)[0];
  view.id = 77;
  expect_equal(again, run_views(*context, {&view, 1}, 7)[0]);
}

TEST_F(CPlan, FrameThatFailedToRecordHasNoMemoryReportAndNoPlan) {
  EXPECT_GT(run_memory(context(), draw_least()).allocated, 0u);
  EXPECT_NE(print_plan(context()), "");
  EXPECT_EQ(record(context(), make_frame({}, 0)), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(get_memory(context()).allocated, 0u);
  EXPECT_EQ(print_plan(context()), "");
}

// The loop of the guide.
TEST_F(CPlan, SizesInTheListAreWithinFivePercentOfTheMemoryOfARecordedFrame) {
  for (const AlcoveQuality quality : {ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_MEDIUM}) {
    HostView from = draw_view(256, 128, {tilted_plane(20.0, 4.0)});
    from.settings = OcclusionSettings(quality);
    from.settings.bent_normal = true;
    from.settings.specular = ALCOVE_SPECULAR_SLICES;
    from.motion = from.back_depth_ndc = from.second_depth_ndc = {};
    const Context context = create_context();
    const AlcoveMemory memory = run_memory(*context, from);
    const AlcoveWorkInfo info = work_info(create_view(from));
    const auto work = std::make_unique<AlcoveWork>();
    ASSERT_EQ(alcoveDescribeWork(&info, work.get(), nullptr), ALCOVE_SUCCESS);
    double transients = 0.0, history = 0.0;
    for (const AlcoveWorkResource& resource : std::span(work->resources, work->resource_count))
      (resource.kind == ALCOVE_RESOURCE_KIND_TRANSIENT ? transients : history) +=
          static_cast<double>(resource.size);
    EXPECT_NEAR(static_cast<double>(memory.history), history, 0.05 * history);
    EXPECT_NEAR(static_cast<double>(memory.transients_unshared), transients, 0.05 * transients);
  }
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
  (void)run_views(*context, views, 0);
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

// The parameter is the number of frames in flight. With an odd number, each frame slot uses both
// images of a history in turn. Each frame has two views with every output. The device has no
// validation layers, because the layers allocate memory.
class CSteadyFrame : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(FramesInFlight, CSteadyFrame, testing::Values(1u, 2u, 3u));

TEST_P(CSteadyFrame, SteadyFrameAllocatesNothingCreatesNoVulkanObjectAndUpdatesNoDescriptor) {
  const auto device = sample::VulkanDevice::create();
  ASSERT_TRUE(device) << device.error();
  TestEngine engine(**device);
  AlcoveContextInfo info = engine.context_info();
  info.frames_in_flight = GetParam();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  const Context context = create_context(info);
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
  settings.specular = ALCOVE_SPECULAR_TABLE;
  std::array<AlcoveView, 2> views{};
  for (AlcoveView& view : views) {
    view = engine.make_view(settings, 24, 16,
                            {ALCOVE_IMAGE_DEPTH, ALCOVE_IMAGE_NORMALS, ALCOVE_IMAGE_ROUGHNESS,
                             ALCOVE_IMAGE_ALBEDO, ALCOVE_IMAGE_VISIBILITY, ALCOVE_IMAGE_BENT_NORMAL,
                             ALCOVE_IMAGE_SPECULAR, ALCOVE_IMAGE_MULTI_BOUNCE});
    view.info.id = 4000000000u + static_cast<std::uint32_t>(&view - views.data());
    view.info.camera = test_views()[2].view;
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
      view.info.previous_camera = view.info.camera;
      view.info.camera.view_from_world[12] = std::sin(static_cast<float>(frame.index));
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
