// The part of the host program that public sample renderers keep in a base class: instance, device,
// queues, images, buffers, pipelines. It knows nothing of Alcove.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace host {

// Ends the program with a message if `condition` is false.
void require(bool condition, const char* message);
inline void require(VkResult result, const char* message) {
  require(result == VK_SUCCESS, message);
}

struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;  // of all aspects of the format
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageUsageFlags usage = 0;
};

struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::byte* mapped = nullptr;
};

struct PipelineDescription {
  std::span<const std::uint32_t> vertex;  // SPIR-V
  std::span<const std::uint32_t> fragment;
  VkPipelineLayout layout;
  VkRenderPass render_pass;
  bool has_vertices;  // position and normal, and a depth test; else a triangle without a buffer
  VkBool32 packed;    // the specialisation constant kPacked of the fragment shader
};

class Base {
 public:
  // Opens the first device that has a graphics queue. If `async` is true, also gets a second queue:
  // one of another family without graphics if the device has such a family, or else another queue
  // of the same family, or else the graphics queue itself.
  void open(const VkPhysicalDeviceFeatures2& features, bool async);
  void close();

  Image create_image(VkFormat format, VkExtent2D size, VkImageUsageFlags usage) const;
  void destroy(Image& image) const;
  Buffer create_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const;
  void destroy(Buffer& buffer) const;
  VkPipeline create_pipeline(const PipelineDescription& description) const;
  // Creates an object with a function such as vkCreateSampler.
  template <typename Info, typename Object>
  Object create(VkResult (*function)(VkDevice, const Info*, const VkAllocationCallbacks*, Object*),
                const Info& info) const {
    Object object = VK_NULL_HANDLE;
    require(function(device, &info, nullptr, &object), "an object of Vulkan cannot be created");
    return object;
  }
  VkCommandBuffer allocate_commands(std::uint32_t family) const;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t graphics_family = 0;
  std::uint32_t compute_family = 0;
  VkQueue graphics_queue = VK_NULL_HANDLE;
  VkQueue compute_queue = VK_NULL_HANDLE;

 private:
  VkDeviceMemory allocate(const VkMemoryRequirements& requirements,
                          VkMemoryPropertyFlags properties) const;
  std::vector<VkCommandPool> pools_;  // by queue family
};

}  // namespace host
