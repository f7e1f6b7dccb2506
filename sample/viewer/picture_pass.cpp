#include "viewer/picture_pass.h"

#include <algorithm>
#include <array>
#include <limits>

#include "alcove/framegraph/access.h"
#include "render/shader_module.h"
#include "spirv/picture_fragment.h"
#include "spirv/picture_vertex.h"

namespace alcove::sample {
namespace {

// The textures in the order of the bindings of picture.frag.
using Textures = std::array<Texture, 4>;

// Returns the textures of all bindings. A texture that is not given is replaced by the shown one,
// because every binding needs a texture.
Textures textures_of(const Shown& shown) {
  Textures textures{shown.texture, shown.other, shown.linear_depth, shown.environment};
  for (Texture& texture : textures) {
    texture = texture ? texture : shown.texture;
  }
  return textures;
}

maths::PictureParameters parameters_of(const Shown& shown) {
  maths::PictureParameters parameters{};
  parameters.world_from_shown = glm::mat4(shown.world_from_shown);
  parameters.show = shown.show;
  parameters.split = shown.other ? shown.split : std::numeric_limits<float>::max();
  parameters.scale = shown.scale;
  return parameters;
}

}  // namespace

tl::expected<std::unique_ptr<PicturePass>, std::string> PicturePass::create(Gpu& gpu,
                                                                            VkFormat format) {
  std::unique_ptr<PicturePass> made(new PicturePass(gpu.device()));
  VkResult result = made->create_layout();
  if (result == VK_SUCCESS) {
    result = made->create_pipeline(format);
  }
  if (result == VK_SUCCESS) {
    result = made->create_sets(gpu.frames_in_flight());
  }
  if (result != VK_SUCCESS) {
    return device_failure("create the pipeline of the window's picture", result);
  }
  return made;
}

PicturePass::~PicturePass() {
  const VkDevice device = device_.device();
  vkDestroyDescriptorPool(device, pool_, nullptr);
  vkDestroyPipeline(device, pipeline_, nullptr);
  vkDestroyPipelineLayout(device, layout_, nullptr);
  vkDestroyDescriptorSetLayout(device, set_layout_, nullptr);
  vkDestroySampler(device, sampler_, nullptr);
}

VkResult PicturePass::create_layout() {
  const VkDevice device = device_.device();
  // The linear filter is for the environment. The other textures are read with texelFetch.
  const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                    .magFilter = VK_FILTER_LINEAR,
                                    .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  if (const VkResult result = vkCreateSampler(device, &sampler, nullptr, &sampler_);
      result != VK_SUCCESS) {
    return result;
  }
  std::array<VkDescriptorSetLayoutBinding, std::tuple_size_v<Textures>> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                   nullptr};
  }
  const VkDescriptorSetLayoutCreateInfo set{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = static_cast<std::uint32_t>(bindings.size()),
      .pBindings = bindings.data()};
  if (const VkResult result = vkCreateDescriptorSetLayout(device, &set, nullptr, &set_layout_);
      result != VK_SUCCESS) {
    return result;
  }
  const VkPushConstantRange range{VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                  sizeof(maths::PictureParameters)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout_,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &range};
  return vkCreatePipelineLayout(device, &info, nullptr, &layout_);
}

VkResult PicturePass::create_pipeline(VkFormat format) {
  const ShaderStages stages(device_.device(), kPictureVertex, kPictureFragment);
  if (stages.result != VK_SUCCESS) {
    return stages.result;
  }
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
  const VkPipelineMultisampleStateCreateInfo multisample{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
      .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineColorBlendAttachmentState attachment{.colorWriteMask = 0xf};
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
      .attachmentCount = 1,
      .pAttachments = &attachment};
  const std::array<VkDynamicState, 2> states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = static_cast<std::uint32_t>(states.size()),
      .pDynamicStates = states.data()};
  const VkPipelineRenderingCreateInfo rendering{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = 1,
      .pColorAttachmentFormats = &format};
  const VkGraphicsPipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
      .pNext = &rendering,
      .stageCount = static_cast<std::uint32_t>(stages.infos.size()),
      .pStages = stages.infos.data(),
      .pVertexInputState = &vertices,
      .pInputAssemblyState = &assembly,
      .pViewportState = &viewport,
      .pRasterizationState = &rasterisation,
      .pMultisampleState = &multisample,
      .pColorBlendState = &blend,
      .pDynamicState = &dynamic,
      .layout = layout_};
  return vkCreateGraphicsPipelines(device_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
}

VkResult PicturePass::create_sets(std::uint32_t count) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  count * static_cast<std::uint32_t>(std::tuple_size_v<Textures>)};
  const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = count,
                                        .poolSizeCount = 1,
                                        .pPoolSizes = &size};
  if (const VkResult result = vkCreateDescriptorPool(device_.device(), &pool, nullptr, &pool_);
      result != VK_SUCCESS) {
    return result;
  }
  const std::vector<VkDescriptorSetLayout> layouts(count, set_layout_);
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool_,
                                         .descriptorSetCount = count,
                                         .pSetLayouts = layouts.data()};
  sets_.resize(count);
  return vkAllocateDescriptorSets(device_.device(), &info, sets_.data());
}

Texture PicturePass::add(Graph& graph, Texture target, const Shown& shown) {
  auto pass = graph.add_pass("picture");
  std::vector<Texture> read;
  for (const Texture texture : textures_of(shown)) {
    if (std::ranges::find(read, texture) == read.end()) {
      pass.read(texture, framegraph::access::sampled_fragment);
      read.push_back(texture);
    }
  }
  const Texture drawn =
      pass.write(target, framegraph::access::color_attachment, {}, framegraph::Contents::discard);
  pass.record([this, drawn, shown](RecordContext& context) { record(context, drawn, shown); });
  return drawn;
}

void PicturePass::record(RecordContext& context, Texture target, const Shown& shown) const {
  const Textures textures = textures_of(shown);
  const VkDescriptorSet set = sets_[context.frame_slot];
  std::array<VkDescriptorImageInfo, std::tuple_size_v<Textures>> images{};
  for (std::size_t i = 0; i < textures.size(); ++i) {
    images[i] = {sampler_, context.view(textures[i]), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  }
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .descriptorCount = static_cast<std::uint32_t>(images.size()),
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = images.data()};
  vkUpdateDescriptorSets(device_.device(), 1, &write, 0, nullptr);

  const VkExtent3D size = context.extent(target);
  const VkRect2D area{{0, 0}, {size.width, size.height}};
  const VkRenderingAttachmentInfo attachment{
      .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
      .imageView = context.view(target),
      .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
      .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
      .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                             .renderArea = area,
                             .layerCount = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments = &attachment};
  const maths::PictureParameters parameters = parameters_of(shown);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(size.width), static_cast<float>(size.height), 0.0f, 1.0f};
  vkCmdBeginRendering(context.commands, &info);
  vkCmdSetViewport(context.commands, 0, 1, &viewport);
  vkCmdSetScissor(context.commands, 0, 1, &area);
  vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set, 0,
                          nullptr);
  vkCmdPushConstants(context.commands, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(parameters),
                     &parameters);
  vkCmdDraw(context.commands, 3, 1, 0, 0);
  vkCmdEndRendering(context.commands);
}

}  // namespace alcove::sample
