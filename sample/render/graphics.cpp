#include "render/graphics.h"

#include <algorithm>
#include <array>

namespace alcove::sample {
namespace {

VkResult create_module(VkDevice device, std::span<const std::uint32_t> code,
                       VkShaderModule& module) {
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = code.size_bytes(),
                                      .pCode = code.data()};
  return vkCreateShaderModule(device, &info, nullptr, &module);
}

VkResult create_from_stages(VkDevice device, const PipelineDescription& description,
                            std::span<const VkPipelineShaderStageCreateInfo> stages,
                            VkPipeline& pipeline) {
  const VkPipelineVertexInputStateCreateInfo vertices{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = static_cast<std::uint32_t>(description.streams.size()),
      .pVertexBindingDescriptions = description.streams.data(),
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(description.attributes.size()),
      .pVertexAttributeDescriptions = description.attributes.data()};
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
  const VkBool32 depth_test = description.depth_format != VK_FORMAT_UNDEFINED;
  const VkPipelineDepthStencilStateCreateInfo depth{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = depth_test,
      .depthWriteEnable = depth_test,
      .depthCompareOp = description.depth_compare};
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(
      description.colour_formats.size(),
      VkPipelineColorBlendAttachmentState{.colorWriteMask = 0xf});
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
      .attachmentCount = static_cast<std::uint32_t>(attachments.size()),
      .pAttachments = attachments.data()};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = static_cast<std::uint32_t>(description.dynamic_states.size()),
      .pDynamicStates = description.dynamic_states.data()};
  const VkPipelineRenderingCreateInfo rendering{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = static_cast<std::uint32_t>(description.colour_formats.size()),
      .pColorAttachmentFormats = description.colour_formats.data(),
      .depthAttachmentFormat = description.depth_format};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = static_cast<std::uint32_t>(stages.size()),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &vertices,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &rasterisation,
                                          .pMultisampleState = &multisample,
                                          .pDepthStencilState = &depth,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = description.layout};
  return vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
}

}  // namespace

VkResult create_pipeline(VkDevice device, PipelineDescription description, VkPipeline& pipeline) {
  description.dynamic_states.insert(description.dynamic_states.end(),
                                    {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR});
  std::array<VkShaderModule, 2> modules{};
  VkResult result = create_module(device, description.vertex_code, modules[0]);
  if (result == VK_SUCCESS) result = create_module(device, description.fragment_code, modules[1]);
  if (result == VK_SUCCESS) {
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = modules[0],
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = modules[1],
         .pName = "main",
         .pSpecializationInfo = description.fragment_constants}};
    result = create_from_stages(device, description, stages, pipeline);
  }
  for (const VkShaderModule module : modules) vkDestroyShaderModule(device, module, nullptr);
  return result;
}

VkResult PipelineLayout::create(std::span<const SetDescription> sets,
                                const VkPushConstantRange& push_constants) {
  for (const SetDescription& set : sets) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const Descriptor& descriptor : set.descriptors) {
      bindings.push_back({static_cast<std::uint32_t>(bindings.size()), descriptor.type,
                          descriptor.count, descriptor.stages, nullptr});
    }
    const VkDescriptorSetLayoutCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = static_cast<std::uint32_t>(bindings.size()),
        .pBindings = bindings.data()};
    const VkResult result =
        vkCreateDescriptorSetLayout(device_, &info, nullptr, &set_layouts_.emplace_back());
    if (result != VK_SUCCESS) return result;
  }
  const VkPipelineLayoutCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = static_cast<std::uint32_t>(set_layouts_.size()),
      .pSetLayouts = set_layouts_.data(),
      .pushConstantRangeCount = 1,
      .pPushConstantRanges = &push_constants};
  const VkResult result = vkCreatePipelineLayout(device_, &info, nullptr, &layout_);
  return result == VK_SUCCESS ? allocate(sets) : result;
}

VkResult PipelineLayout::allocate(std::span<const SetDescription> sets) {
  std::vector<VkDescriptorPoolSize> sizes;
  std::uint32_t count = 0;
  for (const SetDescription& set : sets) {
    count += set.count;
    for (const Descriptor& descriptor : set.descriptors)
      sizes.push_back({descriptor.type, descriptor.count * std::max(set.count, 1u)});
  }
  const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = count,
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  VkResult result = vkCreateDescriptorPool(device_, &pool, nullptr, &pool_);
  sets_.resize(sets.size());
  for (std::size_t i = 0; result == VK_SUCCESS && i < sets.size(); ++i) {
    const std::vector<VkDescriptorSetLayout> layouts(sets[i].count, set_layouts_[i]);
    const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = pool_,
                                           .descriptorSetCount = sets[i].count,
                                           .pSetLayouts = layouts.data()};
    sets_[i].resize(sets[i].count);
    if (sets[i].count > 0) result = vkAllocateDescriptorSets(device_, &info, sets_[i].data());
  }
  return result;
}

PipelineLayout::~PipelineLayout() {
  vkDestroyDescriptorPool(device_, pool_, nullptr);
  vkDestroyPipelineLayout(device_, layout_, nullptr);
  for (const VkDescriptorSetLayout layout : set_layouts_)
    vkDestroyDescriptorSetLayout(device_, layout, nullptr);
}

void PipelineLayout::write(VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                           std::span<const VkDescriptorImageInfo> images,
                           const VkDescriptorBufferInfo* buffer) const {
  const auto count = static_cast<std::uint32_t>(images.size());
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .dstBinding = binding,
                                   .descriptorCount = buffer != nullptr ? 1 : count,
                                   .descriptorType = type,
                                   .pImageInfo = images.data(),
                                   .pBufferInfo = buffer};
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void PipelineLayout::bind(VkCommandBuffer commands, std::uint32_t number, VkDescriptorSet set,
                          std::span<const std::uint32_t> offsets) const {
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, number, 1, &set,
                          static_cast<std::uint32_t>(offsets.size()), offsets.data());
}

void begin_rendering(const framegraph::RecordContext& context,
                     std::span<const framegraph::Attachment> colours,
                     const framegraph::Attachment& depth) {
  std::vector<VkRenderingAttachmentInfo> infos;
  for (const framegraph::Attachment& colour : colours) infos.push_back(context.attachment(colour));
  const VkRenderingAttachmentInfo depth_info =
      depth.texture ? context.attachment(depth) : VkRenderingAttachmentInfo{};
  const VkExtent3D size = context.extent(depth.texture ? depth.texture : colours[0].texture);
  const VkRect2D area{{0, 0}, {size.width, size.height}};
  const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                             .renderArea = area,
                             .layerCount = 1,
                             .colorAttachmentCount = static_cast<std::uint32_t>(infos.size()),
                             .pColorAttachments = infos.data(),
                             .pDepthAttachment = depth.texture ? &depth_info : nullptr};
  vkCmdBeginRendering(context.commands, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(size.width), static_cast<float>(size.height), 0.0f, 1.0f};
  vkCmdSetViewport(context.commands, 0, 1, &viewport);
  vkCmdSetScissor(context.commands, 0, 1, &area);
}

}  // namespace alcove::sample
