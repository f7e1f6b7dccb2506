#include "compute_run.h"

#include <gtest/gtest.h>

namespace alcove::maths_test {
namespace {

void check(VkResult result) { EXPECT_EQ(result, VK_SUCCESS) << sample::result_name(result); }

VkDescriptorType type_of(std::size_t binding) {
  return binding == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

}  // namespace

ComputeRun::ComputeRun(const sample::VulkanDevice& device, std::span<const std::uint32_t> spirv,
                       std::vector<std::uint32_t> buffer_sizes)
    : owner_(device), device_(device.device()) {
  for (std::size_t k = 0; k < buffer_sizes.size(); ++k) {
    auto buffer = sample::HostBuffer::create(
        device, buffer_sizes[k],
        k == 0 ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    if (!buffer) {
      ADD_FAILURE() << buffer.error();
      return;
    }
    buffers_.push_back(std::move(*buffer));
  }
  make_descriptors(buffer_sizes);
  make_pipeline(spirv);
  make_commands();
}

ComputeRun::~ComputeRun() {
  vkDestroyCommandPool(device_, command_pool_, nullptr);
  vkDestroyPipeline(device_, pipeline_, nullptr);
  vkDestroyPipelineLayout(device_, layout_, nullptr);
  vkDestroyDescriptorPool(device_, descriptor_pool_, nullptr);
  vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
}

void ComputeRun::make_descriptors(const std::vector<std::uint32_t>& sizes) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    bindings.push_back({std::uint32_t(k), type_of(k), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout.bindingCount = std::uint32_t(bindings.size());
  layout.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_, &layout, nullptr, &set_layout_));

  const VkDescriptorPoolSize pool_sizes[] = {
      {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
      {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::uint32_t(sizes.size())}};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = 1;
  pool.poolSizeCount = 2;
  pool.pPoolSizes = pool_sizes;
  check(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptor_pool_));
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = descriptor_pool_;
  allocation.descriptorSetCount = 1;
  allocation.pSetLayouts = &set_layout_;
  check(vkAllocateDescriptorSets(device_, &allocation, &set_));

  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const VkDescriptorBufferInfo range{buffers_[k]->buffer(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.dstBinding = std::uint32_t(k);
    write.descriptorCount = 1;
    write.descriptorType = type_of(k);
    write.pBufferInfo = &range;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  }
}

void ComputeRun::make_pipeline(std::span<const std::uint32_t> spirv) {
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, 8};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &push;
  check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_));

  VkShaderModuleCreateInfo code{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  code.codeSize = spirv.size_bytes();
  code.pCode = spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device_, &code, nullptr, &module));
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.layout = layout_;
  check(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_));
  vkDestroyShaderModule(device_, module, nullptr);
}

void ComputeRun::make_commands() {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = owner_.queue_family();
  check(vkCreateCommandPool(device_, &pool, nullptr, &command_pool_));
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = command_pool_;
  allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocation.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device_, &allocation, &commands_));
}

void ComputeRun::dispatch(std::uint32_t groups, std::uint32_t push_0, std::uint32_t push_1) {
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &begin));
  const std::uint32_t push[] = {push_0, push_1};
  vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0,
                          nullptr);
  vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, push);
  vkCmdDispatch(commands_, groups, 1, 1);
  VkMemoryBarrier to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  to_host.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
  to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                       0, 1, &to_host, 0, nullptr, 0, nullptr);
  check(vkEndCommandBuffer(commands_));
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  check(vkQueueSubmit(owner_.queue(), 1, &submit, VK_NULL_HANDLE));
  check(vkQueueWaitIdle(owner_.queue()));
}

}  // namespace alcove::maths_test
