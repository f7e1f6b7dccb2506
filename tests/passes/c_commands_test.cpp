// Tests frames that are recorded into secondary command buffers, and frames for a queue family
// without graphics.
#include <gmock/gmock.h>

#include "alcove/framegraph/verify.h"
#include "c/context.h"
#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

class CCommands : public CInterface {
 protected:
  void TearDown() override {
    vkDestroyCommandPool(gpu().device().device(), pool_, nullptr);
    CInterface::TearDown();
  }

  VkCommandBuffer secondary() {
    const VkDevice device = gpu().device().device();
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = gpu().device().queue_family()};
    EXPECT_EQ(vkCreateCommandPool(device, &pool, nullptr, &pool_), VK_SUCCESS);
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_SECONDARY,
                                           .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateCommandBuffers(device, &info, &commands), VK_SUCCESS);
    return commands;
  }

 private:
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

TEST_F(CCommands, FrameRecordedIntoASecondaryCommandBufferGivesTheSameImages) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 32, 24, ball_on_floor());
  AlcoveSettings settings;
  const AlcoveView view = view_of(given, settings);
  const AlcoveFrame frame{
      .struct_size = sizeof frame, .view_count = 1, .views = &view, .diagnose_pixels = VK_TRUE};
  const VkCommandBuffer commands = secondary();
  const VkCommandBufferInheritanceInfo inheritance{
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                       .pInheritanceInfo = &inheritance};
  ASSERT_EQ(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
  ASSERT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS)
      << alcoveGetMessage(context.get());
  ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  engine().submit(0, [&](VkCommandBuffer primary) { vkCmdExecuteCommands(primary, 1, &commands); });
  engine().wait();
  expect_equal(results_of(view), run_by_cpp(given, 0));
}

// A queue family without graphics supports only the pipeline stages of compute and transfer, so the
// plan must name no others. The states of the images are those that INTEGRATION.md gives for images
// that other queues use before and after, ordered by semaphores. The plan is checked by the
// verifier, and the contents are those of a frame on a queue with graphics.
TEST_F(CCommands, FrameForAComputeOnlyQueueUsesNoGraphicsPipelineStage) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 32, 24, ball_on_floor());
  given.settings.bent_normal = true;
  given.settings.specular = Specular::slices;
  given.multi_bounce = true;
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  for (AlcoveImage* image : {&view.depth, &view.normals, &view.motion, &view.roughness,
                             &view.back_depth, &view.second_depth, &view.albedo, &view.visibility,
                             &view.bent_normal, &view.specular, &view.multi_bounce}) {
    image->initial_state.stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    image->initial_state.access = VK_ACCESS_2_NONE;
    image->final_state.stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    image->final_state.access = VK_ACCESS_2_NONE;
  }
  for (std::uint32_t i = 0; i < 2; ++i) {
    run_frame(*context, {&view, 1}, i);
    for (AlcoveImage* image :
         {&view.visibility, &view.bent_normal, &view.specular, &view.multi_bounce})
      image->initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    const std::string plan = plan_of(*context);
    EXPECT_THAT(plan, HasSubstr("compute"));
    for (const char* stage : {"graphics", "vertex", "fragment", "attachment", "draw", "blit"})
      EXPECT_THAT(plan, Not(HasSubstr(stage)));
    const auto right = framegraph::verify(context->graph.description(), context->executor.limits(),
                                          *context->report.plan);
    EXPECT_TRUE(right) << right.error().front().message;
    engine().wait();
    expect_equal(results_of(view), run_by_cpp(given, i));
  }
}

TEST_F(CCommands, MultisampledInputImageIsRefused) {
  const Context context = create_context();
  AlcoveSettings settings;
  AlcoveView view = view_of(given_view(test_views()[2], 16, 12, ball_on_floor()), settings);
  view.normals.samples = 4;
  const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
  EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_STREQ(alcoveGetMessage(context.get()),
               "View 0: the image of normals has 4 samples a pixel; resolve it first, depths and "
               "normals to sample 0.");
  view.normals.samples = 1;
  EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_SUCCESS);
}

}  // namespace
}  // namespace alcove::passes
