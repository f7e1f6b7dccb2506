// Memory that the host writes and the device reads.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <memory>
#include <tl/expected.hpp>

#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::passes {

// A buffer with memory of its own, mapped as long as it lives. The functions and the device outlive
// it; the device must have finished with it before it goes.
class HostBuffer {
 public:
  [[nodiscard]] static tl::expected<std::unique_ptr<HostBuffer>, VkResult> create(
      const framegraph::VulkanFunctions& vk, VkPhysicalDevice physical_device, VkDevice device,
      VkDeviceSize size, VkBufferUsageFlags usage);
  ~HostBuffer();
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  VkBuffer buffer() const { return buffer_; }
  std::byte* bytes() const { return bytes_; }

 private:
  HostBuffer(const framegraph::VulkanFunctions& vk, VkDevice device) : vk_(vk), device_(device) {}
  VkResult allocate(VkPhysicalDevice physical_device);

  const framegraph::VulkanFunctions& vk_;
  VkDevice device_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::byte* bytes_ = nullptr;
};

}  // namespace alcove::passes
