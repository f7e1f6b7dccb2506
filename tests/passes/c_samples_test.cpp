// Tests depth with several samples per pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>

#include "c_interface_fixture.h"
#include "spirv/depth_samples_fragment.h"
#include "spirv/depth_samples_vertex.h"

namespace alcove::passes {
namespace {

constexpr VkExtent2D kSize{37, 26};
constexpr AlcoveState kGeneral{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                               VK_IMAGE_LAYOUT_GENERAL};

// The push constants of depth_samples.frag.
struct Depths {
  float left, right, per_pixel, edge;
  std::uint32_t samples = 1;
};

class CSamples : public CInterface {
 protected:
  // Draws a depth image. Samples after the first hold other depths.
  AlcoveImage draw_depth(VkSampleCountFlagBits samples, const Depths& depths) {
    AlcoveImage image = engine().make_image(
        VK_FORMAT_D32_SFLOAT, kSize.width, kSize.height,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 1, samples);
    image.samples = samples;
    image.initial_state = image.final_state = kGeneral;
    VkDevice device = gpu().device().device();
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    const VkImageViewCreateInfo view_info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                          .image = image.image,
                                          .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                          .format = image.format,
                                          .subresourceRange = range};
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateImageView(device, &view_info, nullptr, &view), VK_SUCCESS);
    const VkPushConstantRange constants{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Depths)};
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &constants};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout), VK_SUCCESS);
    const VkPipeline pipeline = create_pipeline(layout, samples);
    engine().submit(0, [&](VkCommandBuffer commands) {
      const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                          .srcStageMask = kResting.stages,
                                          .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                          .dstAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                          .newLayout = kGeneral.layout,
                                          .image = image.image,
                                          .subresourceRange = range};
      const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                        .imageMemoryBarrierCount = 1,
                                        .pImageMemoryBarriers = &barrier};
      vkCmdPipelineBarrier2(commands, &dependency);
      const VkRenderingAttachmentInfo attachment{
          .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
          .imageView = view,
          .imageLayout = kGeneral.layout,
          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
          .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
      const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                      .renderArea = {{0, 0}, kSize},
                                      .layerCount = 1,
                                      .pDepthAttachment = &attachment};
      vkCmdBeginRendering(commands, &rendering);
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
      for (const Depths& each : {Depths{0.3f, 0.2f, 0.0f, 10.0f, ~1u}, depths}) {
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof each, &each);
        vkCmdDraw(commands, 3, 1, 0, 0);
      }
      vkCmdEndRendering(commands);
    });
    engine().wait();
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyImageView(device, view, nullptr);
    return image;
  }

  VkPipeline create_pipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples) {
    VkDevice device = gpu().device().device();
    const auto create_stage = [&](VkShaderStageFlagBits stage,
                                  std::span<const std::uint32_t> code) {
      const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = code.size_bytes(),
                                          .pCode = code.data()};
      VkPipelineShaderStageCreateInfo shader{
          .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = stage,
          .pName = "main"};
      EXPECT_EQ(vkCreateShaderModule(device, &info, nullptr, &shader.module), VK_SUCCESS);
      return shader;
    };
    const std::array stages{create_stage(VK_SHADER_STAGE_VERTEX_BIT, kDepthSamplesVertex),
                            create_stage(VK_SHADER_STAGE_FRAGMENT_BIT, kDepthSamplesFragment)};
    const VkPipelineVertexInputStateCreateInfo vertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport viewport{
        0.0f, 0.0f, static_cast<float>(kSize.width), static_cast<float>(kSize.height), 0.0f, 1.0f};
    const VkRect2D scissor{{0, 0}, kSize};
    const VkPipelineViewportStateCreateInfo viewports{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo rasterisation{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo multisampling{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = samples};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_ALWAYS};
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
        .pViewportState = &viewports,
        .pRasterizationState = &rasterisation,
        .pMultisampleState = &multisampling,
        .pDepthStencilState = &depth,
        .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
              VK_SUCCESS);
    for (const VkPipelineShaderStageCreateInfo& stage : stages)
      vkDestroyShaderModule(device, stage.module, nullptr);
    return pipeline;
  }
};

class CTileSize : public CSamples, public testing::WithParamInterface<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Samples, CTileSize, testing::Values(4u, 8u));

TEST_P(CTileSize, DepthWithFourSamplesGivesTheResultOfItsFirstSample) {
  HostView from = draw_view(kSize.width, kSize.height, step(0.3, 0.6));
  request_all_outputs(from);
  from.settings.radius = 3.0f;
  from.settings.tile_size = GetParam();
  from.settings.specular = ALCOVE_SPECULAR_TABLE;
  const TestCamera camera(from.view, kSize.width, kSize.height);
  const auto depth_at = [&](double distance) {
    return static_cast<float>(camera.project({0.0, 0.0, -distance}).z);
  };
  const Depths depths{depth_at(4.0), depth_at(3.5), (depth_at(4.0) - depth_at(4.2)) / 26.0f, 20.0f};
  const AlcoveImage single = draw_depth(VK_SAMPLE_COUNT_1_BIT, depths);
  const AlcoveImage several = draw_depth(VK_SAMPLE_COUNT_4_BIT, depths);
  for (const bool normals : {true, false}) {
    if (!normals) from.normals = {};
    for (const AlcoveArea& area : {AlcoveArea{}, AlcoveArea{4, 2, 30, 20}}) {
      std::array<AlcoveView, 2> views{create_view(from), create_view(from)};
      views[0].images[ALCOVE_IMAGE_DEPTH] = single;
      views[1].images[ALCOVE_IMAGE_DEPTH] = several;
      views[1].info.id = 1;
      for (std::uint32_t index = 0; index < 3; ++index) {
        for (AlcoveView& view : views) {
          view.info.read_area = area;
          view.info.reset_history = index == 0 ? VK_TRUE : VK_FALSE;
        }
        const std::vector<HostOutputs> results = run_views(context(), views, index);
        const HostOutputs &expected = results[0], &outputs = results[1];
        EXPECT_LT(std::ranges::min(expected.visibility.texels), 0.97f);
        if (area.width == 0) expect_equal(outputs, expected);
        for (std::uint32_t y = 0; y < area.height; ++y)
          for (std::uint32_t x = 0; x < area.width; ++x)
            ASSERT_EQ(outputs.visibility.at(x, y), expected.visibility.at(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
