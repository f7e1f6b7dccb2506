// Counts the pipelines that are created by preparing and recording frames, and checks from which
// pipeline cache they come. Tests frames in secondary command buffers, and frames for a queue
// family without graphics.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "alcove/framegraph/verify.h"
#include "c/context.h"
#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

// Number of pipelines created since the test began, and the pipeline caches that they were created
// with.
std::uint32_t pipelines = 0;
std::set<VkPipelineCache> caches;
bool compiles = true;  // else pipelines are only counted, and are null

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                std::uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* callbacks,
                                                VkPipeline* handles) {
  pipelines += count;
  caches.insert(cache);
  std::fill_n(handles, count, VkPipeline{VK_NULL_HANDLE});
  if (!compiles) return VK_SUCCESS;
  return vkCreateComputePipelines(device, cache, count, infos, callbacks, handles);
}

class CPipelines : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    pipelines = 0;
    caches.clear();
    compiles = true;
    replaced_functions = {{"vkCreateComputePipelines", untyped(&create_pipelines)}};
  }

  // Creates a context whose calls of vkCreateComputePipelines are counted.
  Context create_counted(VkPipelineCache cache = VK_NULL_HANDLE) {
    AlcoveContextInfo info = engine().context_info();
    info.get_instance_proc_addr = get_replaced_function;
    info.pipeline_cache = cache;
    return create_context(info);
  }

  static void prepare(AlcoveContext& context, const AlcoveView& view) {
    const AlcoveFrame frame = make_frame({&view, 1}, 0);
    EXPECT_EQ(alcovePrepareFrame(&context, &frame), ALCOVE_SUCCESS) << alcoveGetMessage(&context);
  }

  // Records frames of every kind that a view has: its first frame, frames in motion, static frames,
  // a cut, motion again, a static camera with static_frames 0, a smaller size within largest_width
  // and largest_height, and a change of the largest size. Several frames are in flight, which
  // write the same images.
  void run_life(AlcoveContext& context, AlcoveView view) {
    std::uint32_t index = 0;
    const auto run_at = [&](float x) {
      view.info.previous_camera = view.info.camera;
      view.info.camera.view_from_world[12] = x;
      run_frame(context, {&view, 1}, index++);
      view.info.reset_history = VK_FALSE;
    };
    run_at(0.0f);
    run_at(0.1f);
    for (view.info.static_frames = 1; view.info.static_frames <= 20; ++view.info.static_frames)
      run_at(0.1f);
    view.info.static_frames = 0;
    view.info.reset_history = VK_TRUE;
    run_at(0.5f);
    run_at(0.6f);
    run_at(0.6f);
    view.info.previous_width = view.images[ALCOVE_IMAGE_DEPTH].width;
    view.info.previous_height = view.images[ALCOVE_IMAGE_DEPTH].height;
    for (AlcoveImage& image : view.images) image.height -= image.height > 0 ? 2 : 0;
    run_at(0.6f);
    view.info.largest_height = view.info.previous_height = view.images[ALCOVE_IMAGE_DEPTH].height;
    run_at(0.7f);
    engine().wait();
  }
};

TEST_F(CPipelines, PipelinesAreCreatedWithTheEnginesPipelineCacheWhichIsNotDestroyed) {
  const HostView from = draw_view(16, 12);
  (void)run_views(*create_counted(), {&from, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(VkPipelineCache{VK_NULL_HANDLE})) << "by default";

  const VkDevice device = gpu().device().device();
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreatePipelineCache(device, &info, nullptr, &cache), VK_SUCCESS);
  caches.clear();
  (void)run_views(*create_counted(cache), {&from, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(cache));
  std::size_t size = 0;
  EXPECT_EQ(vkGetPipelineCacheData(device, cache, &size, nullptr), VK_SUCCESS);
  vkDestroyPipelineCache(device, cache, nullptr);
}

// The number of pipelines that alcovePrepareFrame creates equals the number that recording creates
// for a view that was not prepared. Recording a prepared view creates none.
TEST_F(CPipelines, PreparingAFrameCreatesAllPipelinesThatItsViewsEverNeed) {
  struct Case {
    const char* name;
    void (*change)(HostView&);
  };
  const Case cases[] = {
      {"depth alone", [](HostView& v) { v.normals = v.motion = {}; }},
      {"low, every output by slices",
       [](HostView& v) {
         v.settings = OcclusionSettings(ALCOVE_QUALITY_LOW, 0.4f);
         request_all_outputs(v);
       }},
      {"hidden depths, every output by the table",
       [](HostView& v) {
         v.settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
         v.settings.depth_layers = 2;
         request_all_outputs(v);
         v.settings.specular = ALCOVE_SPECULAR_TABLE;
       }},
      {"orthographic",
       [](HostView& v) {
         v.view = v.previous_view = orthographic_view("", 3.0, 2.0, 0.1, 20.0).view;
         v.motion = {};
       }},
      {"without a history", [](HostView& v) { v.settings.history_frames = 0; }},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    HostView from = draw_view(16, 12);
    from.largest_size = {16, 12};
    each.change(from);
    AlcoveView view = create_view(from);
    pipelines = 0;
    run_life(*create_counted(), view);
    const std::uint32_t pipelines_of_life = pipelines;
    pipelines = 0;
    const Context context = create_counted();
    prepare(*context, view);
    EXPECT_EQ(pipelines, pipelines_of_life);
    run_life(*context, view);
    EXPECT_EQ(pipelines, pipelines_of_life);
    // A static frame prepares the same pipelines as a moving one.
    pipelines = 0;
    compiles = false;
    view.info.static_frames = 20;
    prepare(*create_counted(), view);
    compiles = true;
    EXPECT_EQ(pipelines, pipelines_of_life);
  }
}

TEST_F(CPipelines, PreparingAFrameDoesNotAffectRecordedFrames) {
  HostView other = draw_view(16, 12);
  other.settings.bent_normal = true;
  AlcoveView prepared = create_view(other);
  for (std::uint32_t i = 0; i < 4; ++i) {
    HostView from = draw_view(33, 17);
    from.settings.bent_normal = true;
    from.static_frames = i;
    prepared.info.reset_history = i % 2 == 0 ? VK_TRUE : VK_FALSE;
    prepare(context(), prepared);
    expect_equal(run_views(context(), {&from, 1}, i)[0], run_plainly(from, i));
    const std::string plan = print_plan(context());
    const VkDeviceSize transients = get_memory(context()).transients;
    prepare(context(), prepared);
    EXPECT_EQ(print_plan(context()), plan);
    EXPECT_EQ(get_memory(context()).transients, transients);
  }
}

TEST_F(CPipelines, FrameRecordedIntoASecondaryCommandBufferGivesTheSameImages) {
  const VkDevice device = gpu().device().device();
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = gpu().device().queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateCommandPool(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool,
                                         .level = VK_COMMAND_BUFFER_LEVEL_SECONDARY,
                                         .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  ASSERT_EQ(vkAllocateCommandBuffers(device, &info, &commands), VK_SUCCESS);
  const VkCommandBufferInheritanceInfo inheritance{
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                       .pInheritanceInfo = &inheritance};
  ASSERT_EQ(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
  const HostView from = draw_view(32, 24);
  const AlcoveView view = create_view(from);
  AlcoveFrame frame = make_frame({&view, 1}, 0);
  frame.diagnose_pixels = VK_TRUE;
  EXPECT_EQ(alcoveRecordFrame(&context(), commands, &frame), ALCOVE_SUCCESS);
  ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  engine().submit(0, [&](VkCommandBuffer primary) { vkCmdExecuteCommands(primary, 1, &commands); });
  engine().wait();
  expect_equal(read_results(view), run_plainly(from, 0));
  vkDestroyCommandPool(device, pool, nullptr);
}

// A queue family without graphics supports only the pipeline stages of compute and transfer, so the
// plan must name no others. The states of the images are those that INTEGRATION.md gives for images
// that other queues use before and after, ordered by semaphores. The plan is checked by the
// verifier, and the contents are those of a frame on a queue with graphics.
TEST_F(CPipelines, FrameForAComputeOnlyQueueUsesNoGraphicsPipelineStage) {
  HostView from = draw_view(32, 24);
  request_all_outputs(from);
  AlcoveView view = create_view(from);
  for (AlcoveImage& image : view.images) {
    image.initial_state.stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    image.final_state.stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    image.initial_state.access = image.final_state.access = VK_ACCESS_2_NONE;
  }
  for (std::uint32_t i = 0; i < 2; ++i) {
    const HostOutputs outputs = run_view(view, i);
    const std::string plan = print_plan(context());
    EXPECT_THAT(plan, testing::HasSubstr("compute"));
    for (const char* stage : {"graphics", "vertex", "fragment", "attachment", "draw", "blit"})
      EXPECT_THAT(plan, testing::Not(testing::HasSubstr(stage)));
    const auto verification = framegraph::verify(
        context().graph.description(), context().executor.limits(), *context().report.plan);
    EXPECT_TRUE(verification) << verification.error().front().message;
    expect_equal(outputs, run_plainly(from, i));
  }
}

}  // namespace
}  // namespace alcove::passes
