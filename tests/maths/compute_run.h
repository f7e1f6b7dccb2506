// Runs one compute shader over buffers and reads the results back.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/gpu.h"

namespace alcove::maths_test {

// A compute pipeline whose descriptor set 0 has a uniform buffer at binding 0 and storage buffers
// from binding 1 on, all in host-visible memory. If a Vulkan call fails, the running test fails,
// and the buffers contain zeros.
class ComputeRun {
 public:
  // Sizes are in bytes. The device must outlive the object.
  ComputeRun(const sample::VulkanDevice& device, std::span<const std::uint32_t> spirv,
             std::vector<std::uint32_t> buffer_sizes);
  ~ComputeRun();
  ComputeRun(const ComputeRun&) = delete;
  ComputeRun& operator=(const ComputeRun&) = delete;

  // Returns the mapped memory of a buffer. Read results after dispatch().
  void* data(std::size_t buffer) const { return buffers_[buffer]->bytes().data(); }

  // Runs `groups` workgroups with two words of push constants and waits for them.
  void dispatch(std::uint32_t groups, std::uint32_t push_0, std::uint32_t push_1);

 private:
  void make_descriptors(const std::vector<std::uint32_t>& sizes);
  void make_pipeline(std::span<const std::uint32_t> spirv);
  void make_commands();

  const sample::VulkanDevice& owner_;
  VkDevice device_;
  std::vector<std::unique_ptr<sample::HostBuffer>> buffers_;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkCommandPool command_pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

}  // namespace alcove::maths_test
