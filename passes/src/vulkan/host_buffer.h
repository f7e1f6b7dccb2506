// A buffer that the host writes and the device reads.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <memory>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/framegraph/executor.h"
#include "alcove/passes/error.h"

namespace alcove::passes {

// A buffer with its own memory, which stays mapped. The Vulkan functions, the device and the
// caller's allocators must outlive it. Destroy it only after the device has finished using it.
class HostBuffer {
 public:
  // The error calls the buffer `name`.
  [[nodiscard]] static tl::expected<std::unique_ptr<HostBuffer>, Error> create(
      const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device,
      std::string_view name, VkDeviceSize size, VkBufferUsageFlags usage);
  ~HostBuffer();
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  VkBuffer buffer() const { return buffer_; }
  std::byte* bytes() const { return static_cast<std::byte*>(memory_.mapped); }

 private:
  HostBuffer(const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device)
      : vk_(vk), device_(device) {}
  VkResult allocate();

  const framegraph::VulkanFunctions& vk_;
  const framegraph::DeviceHandles& device_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  framegraph::MemoryRange memory_;
};

}  // namespace alcove::passes
