#include "checksum_kernels.h"

#include "spirv/checksum_buffer.h"
#include "spirv/checksum_texture.h"

namespace alcove::framegraph {

ChecksumKernels::ChecksumKernels(Gpu& gpu) : device_(gpu.device().device()) {
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 4096},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 8192},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8192}};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = 4096,
                                        .poolSizeCount = 3,
                                        .pPoolSizes = sizes};
  vkCreateDescriptorPool(device_, &info, nullptr, &pool_);
  texture_ = make(kChecksumTexture, sizeof kChecksumTexture, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  buffer_ = make(kChecksumBuffer, sizeof kChecksumBuffer, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
}

ChecksumKernels::~ChecksumKernels() {
  destroy(texture_);
  destroy(buffer_);
  vkDestroyDescriptorPool(device_, pool_, nullptr);
}

void ChecksumKernels::reset() { vkResetDescriptorPool(device_, pool_, 0); }

ChecksumKernels::Kernel ChecksumKernels::make(const std::uint32_t* code, std::size_t size,
                                              VkDescriptorType written) {
  Kernel kernel;
  kernel.written = written;
  VkDescriptorSetLayoutBinding bindings[kBindings];
  for (std::uint32_t i = 0; i < kBindings; ++i)
    bindings[i] = {i, i == 0 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : written, 1,
                   VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = kBindings,
      .pBindings = bindings};
  vkCreateDescriptorSetLayout(device_, &set_info, nullptr, &kernel.set_layout);
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, 8};
  const VkPipelineLayoutCreateInfo layout_info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = 1,
      .pSetLayouts = &kernel.set_layout,
      .pushConstantRangeCount = 1,
      .pPushConstantRanges = &push};
  vkCreatePipelineLayout(device_, &layout_info, nullptr, &kernel.layout);
  const VkShaderModuleCreateInfo module_info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
  VkShaderModule module = VK_NULL_HANDLE;
  vkCreateShaderModule(device_, &module_info, nullptr, &module);
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main"},
      .layout = kernel.layout};
  vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &kernel.pipeline);
  vkDestroyShaderModule(device_, module, nullptr);
  return kernel;
}

void ChecksumKernels::destroy(Kernel& kernel) {
  vkDestroyPipeline(device_, kernel.pipeline, nullptr);
  vkDestroyPipelineLayout(device_, kernel.layout, nullptr);
  vkDestroyDescriptorSetLayout(device_, kernel.set_layout, nullptr);
}

void ChecksumKernels::run(RecordContext& context, const Kernel& kernel, const Resource* resources,
                          VkExtent2D groups, std::uint32_t seed, bool keep) {
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool_,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &kernel.set_layout};
  VkDescriptorSet set = VK_NULL_HANDLE;
  vkAllocateDescriptorSets(device_, &info, &set);
  VkWriteDescriptorSet writes[kBindings] = {};
  for (std::uint32_t i = 0; i < kBindings; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = i == 0 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : kernel.written;
    writes[i].pImageInfo = &resources[i].image;
    writes[i].pBufferInfo = &resources[i].buffer;
  }
  vkUpdateDescriptorSets(device_, kBindings, writes, 0, nullptr);
  const std::uint32_t parameters[2] = {seed, keep ? 1u : 0u};
  vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline);
  vkCmdPushConstants(context.commands, kernel.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8,
                     parameters);
  vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout, 0, 1,
                          &set, 0, nullptr);
  vkCmdDispatch(context.commands, groups.width, groups.height, 1);
}

void ChecksumKernels::mix_texture(RecordContext& context, VkImageView sampled, VkImageView storage,
                                  VkImageView result, VkExtent3D size, std::uint32_t seed,
                                  bool keep) {
  const Resource resources[kBindings] = {
      {.image = {VK_NULL_HANDLE, sampled, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}},
      {.image = {VK_NULL_HANDLE, storage, VK_IMAGE_LAYOUT_GENERAL}},
      {.image = {VK_NULL_HANDLE, result, VK_IMAGE_LAYOUT_GENERAL}}};
  run(context, texture_, resources, {(size.width + 7) / 8, (size.height + 7) / 8}, seed, keep);
}

void ChecksumKernels::mix_buffer(RecordContext& context, VkImageView sampled, VkBuffer from,
                                 VkBuffer to, std::uint32_t words, std::uint32_t seed, bool keep) {
  const Resource resources[kBindings] = {
      {.image = {VK_NULL_HANDLE, sampled, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}},
      {.buffer = {from, 0, VK_WHOLE_SIZE}},
      {.buffer = {to, 0, VK_WHOLE_SIZE}}};
  run(context, buffer_, resources, {(words + 63) / 64, 1}, seed, keep);
}

}  // namespace alcove::framegraph
