// Tests depth with several samples per pixel.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <span>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"
#include "spirv/depth_samples_fragment.h"
#include "spirv/depth_samples_vertex.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

constexpr VkExtent2D kSize{37, 26};

struct Depths {
  float left, right, per_pixel, edge;
};

class CSamples : public CInterface {
 protected:
  // Draws a depth image. Samples after the first hold other depths.
  AlcoveImage draw_depth(VkSampleCountFlagBits samples, const Depths& depths) {
    const VkImageUsageFlags usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    AlcoveImage image =
        engine().make_image(VK_FORMAT_D32_SFLOAT, kSize.width, kSize.height, usage, 1, samples);
    image.samples = samples;
    VkDevice device = gpu().device().device();
    const VkImageViewCreateInfo view_info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = image.format,
        .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateImageView(device, &view_info, nullptr, &view), VK_SUCCESS);
    const VkPushConstantRange range{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Depths)};
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout), VK_SUCCESS);
    const VkPipeline first = create_pipeline(layout, samples, 1u);
    const VkPipeline others = create_pipeline(layout, samples, ~1u);
    const auto barrier = [&](VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) {
      const VkImageMemoryBarrier2 change{
          .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
          .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
          .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
          .oldLayout = from,
          .newLayout = to,
          .image = image.image,
          .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
      const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                  .imageMemoryBarrierCount = 1,
                                  .pImageMemoryBarriers = &change};
      vkCmdPipelineBarrier2(commands, &info);
    };
    engine().submit(0, [&](VkCommandBuffer commands) {
      barrier(commands, kResting.layout, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
      const VkRenderingAttachmentInfo attachment{
          .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
          .imageView = view,
          .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
          .clearValue = {.depthStencil = {1.0f, 0}}};
      const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                      .renderArea = {{0, 0}, kSize},
                                      .layerCount = 1,
                                      .pDepthAttachment = &attachment};
      vkCmdBeginRendering(commands, &rendering);
      const VkViewport viewport{
          0, 0, static_cast<float>(kSize.width), static_cast<float>(kSize.height), 0, 1};
      const VkRect2D scissor{{0, 0}, kSize};
      vkCmdSetViewport(commands, 0, 1, &viewport);
      vkCmdSetScissor(commands, 0, 1, &scissor);
      const auto draw = [&](VkPipeline pipeline, const Depths& with) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof with, &with);
        vkCmdDraw(commands, 3, 1, 0, 0);
      };
      draw(first, depths);
      if (samples != VK_SAMPLE_COUNT_1_BIT) {
        draw(others, {0.3f, 0.2f, 0.0f, 10.0f});
      }
      vkCmdEndRendering(commands);
      barrier(commands, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kResting.layout);
    });
    engine().wait();
    vkDestroyPipeline(device, first, nullptr);
    vkDestroyPipeline(device, others, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyImageView(device, view, nullptr);
    return image;
  }

  VkPipeline create_pipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples,
                             VkSampleMask mask) {
    VkDevice device = gpu().device().device();
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    const auto add_stage = [&](std::size_t i, VkShaderStageFlagBits stage,
                               std::span<const std::uint32_t> code) {
      const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = code.size_bytes(),
                                          .pCode = code.data()};
      stages.at(i) = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = stage,
                      .pName = "main"};
      EXPECT_EQ(vkCreateShaderModule(device, &info, nullptr, &stages.at(i).module), VK_SUCCESS);
    };
    add_stage(0, VK_SHADER_STAGE_VERTEX_BIT, kDepthSamplesVertex);
    add_stage(1, VK_SHADER_STAGE_FRAGMENT_BIT, kDepthSamplesFragment);
    const VkPipelineVertexInputStateCreateInfo vertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo rasterisation{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo multisampling{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = samples,
        .pSampleMask = &mask};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_ALWAYS};
    const VkPipelineColorBlendStateCreateInfo blending{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = kDynamic.size(),
        .pDynamicStates = kDynamic.data()};
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .depthAttachmentFormat = VK_FORMAT_D32_SFLOAT};
    const VkGraphicsPipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .stageCount = stages.size(),
        .pStages = stages.data(),
        .pVertexInputState = &vertices,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &rasterisation,
        .pMultisampleState = &multisampling,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blending,
        .pDynamicState = &dynamic,
        .layout = layout};
    VkPipeline made = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &made),
              VK_SUCCESS);
    for (const VkPipelineShaderStageCreateInfo& stage : stages)
      vkDestroyShaderModule(device, stage.module, nullptr);
    return made;
  }
};

TEST_F(CSamples, DepthWithFourSamplesGivesTheResultOfItsFirstSample) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], kSize.width, kSize.height, step(0.3, 0.6));
  given.settings.radius = 3.0f;
  given.settings.bent_normal = true;
  given.settings.specular = Specular::table;
  given.multi_bounce = true;
  const TestCamera camera(given.view, kSize.width, kSize.height);
  const auto depth_at = [&](double distance) {
    return static_cast<float>(camera.project({0.0, 0.0, -distance}).z);
  };
  const Depths depths{depth_at(4.0), depth_at(3.5), (depth_at(4.0) - depth_at(4.2)) / 26.0f, 20.0f};
  for (const bool normals : {true, false}) {
    for (const AlcoveArea& area : {AlcoveArea{}, AlcoveArea{4, 2, 30, 20}}) {
      if (!normals) given.normals = {};
      AlcoveSettings settings;
      AlcoveView single = view_of(given, settings);
      single.read_area = area;
      AlcoveView several = view_of(given, settings);
      several.read_area = area;
      single.id = normals ? 1 : 2;
      several.id = single.id + 10;
      single.reset_history = several.reset_history = VK_TRUE;
      single.depth = draw_depth(VK_SAMPLE_COUNT_1_BIT, depths);
      several.depth = draw_depth(VK_SAMPLE_COUNT_4_BIT, depths);
      for (std::uint32_t index = 0; index < 3; ++index) {
        const std::array both{single, several};
        run_frame(*context, both, index);
        engine().wait();
        const Results expected = results_of(single);
        const Results found = results_of(several);
        if (area.width == 0) {
          EXPECT_LT(std::ranges::min(expected.visibility.texels), 0.97f);
          expect_equal(found, expected);
        } else {
          for (std::size_t y = 0; y < area.height; ++y) {
            for (std::size_t x = 0; x < area.width; ++x) {
              const std::size_t i = y * kSize.width + x;
              ASSERT_EQ(found.visibility.texels[i], expected.visibility.texels[i]);
            }
          }
        }
        single.reset_history = several.reset_history = VK_FALSE;
      }
    }
  }
}

TEST_F(CSamples, NumbersOfSamplesThatCannotBeUsedAreNamed) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], kSize.width, kSize.height, step(0.3, 0.6));
  AlcoveSettings settings;
  const AlcoveView good = view_of(given, settings);
  const auto expect_refused = [&](const AlcoveView& view, const char* message) {
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_NE(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS);
    });
    EXPECT_THAT(alcoveGetMessage(context.get()), HasSubstr(message));
  };
  AlcoveView view = good;
  view.normals.samples = 4;
  expect_refused(view, "the image of normals has 4 samples a pixel; resolve it first");
  view = good;
  view.depth.samples = 3;
  expect_refused(view, "the image of depth has 3 samples a pixel; it must be a power of two");
  view.depth.samples = 128;
  expect_refused(view, "the image of depth has 128 samples a pixel");
  view.depth.samples = 64;  // more than any device has
  expect_refused(view, "64");
}

}  // namespace
}  // namespace alcove::passes
