// A Vulkan device as an engine for Vulkan 1.2 creates it: the instance requests version 1.2, and
// the device enables VK_KHR_synchronization2, but no other feature that Vulkan 1.3 made core. It
// runs under the validation layers.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "alcove/alcove.h"

namespace alcove::passes {

class Vulkan12Device {
 public:
  explicit Vulkan12Device(bool has_synchronization2 = true);
  ~Vulkan12Device();
  Vulkan12Device(const Vulkan12Device&) = delete;
  Vulkan12Device& operator=(const Vulkan12Device&) = delete;

  // Returns the info for a context with one frame in flight and the loader's vkGetInstanceProcAddr.
  AlcoveContextInfo context_info() const;
  AlcoveImage make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                         VkImageUsageFlags usage);
  // Lets `record` record commands, submits them and waits for them.
  void run(const std::function<void(VkCommandBuffer)>& record);
  // Returns the bytes of a colour image that is in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
  std::vector<unsigned char> read(const AlcoveImage& image, std::uint32_t bytes_per_pixel);

  VkInstance instance() const { return instance_; }
  VkDevice device() const { return device_; }
  // Returns the messages of the validation layers so far.
  const std::string& messages() const { return messages_; }

 private:
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) const;

  std::string messages_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::vector<VkImage> images_;
  std::vector<VkDeviceMemory> memories_;
};

}  // namespace alcove::passes
