#include "vulkan12_device.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace alcove::passes {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* user) {
  *static_cast<std::string*>(user) += std::string(data->pMessage) + '\n';
  return VK_FALSE;
}

}  // namespace

Vulkan12Device::Vulkan12Device(bool has_synchronization2) {
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .apiVersion = VK_API_VERSION_1_2};
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = keep_message,
      .pUserData = &messages_};
  const VkValidationFeatureEnableEXT enabled =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT validation{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messenger,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &enabled};
  const char* layer = "VK_LAYER_KHRONOS_validation";
  const char* debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const VkInstanceCreateInfo instance{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = &validation,
      .pApplicationInfo = &application,
      .enabledLayerCount = std::getenv("ALCOVE_LAYERS_OF_THE_HOST") == nullptr ? 1u : 0u,
      .ppEnabledLayerNames = &layer,
      .enabledExtensionCount = 1,
      .ppEnabledExtensionNames = &debug_utils};
  EXPECT_EQ(vkCreateInstance(&instance, nullptr, &instance_), VK_SUCCESS);
  reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
      instance_, "vkCreateDebugUtilsMessengerEXT"))(instance_, &messenger, nullptr, &messenger_);
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance_, &count, &physical_device_);
  VkPhysicalDeviceSynchronization2Features synchronization2{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
      .synchronization2 = VK_TRUE};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = has_synchronization2 ? &synchronization2 : nullptr};
  features.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const char* extension = VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME;
  const VkDeviceCreateInfo device{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = has_synchronization2 ? 1u : 0u,
                                  .ppEnabledExtensionNames = &extension};
  EXPECT_EQ(vkCreateDevice(physical_device_, &device, nullptr, &device_), VK_SUCCESS);
  vkGetDeviceQueue(device_, 0, 0, &queue_);
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  EXPECT_EQ(vkCreateCommandPool(device_, &pool, nullptr, &pool_), VK_SUCCESS);
}

Vulkan12Device::~Vulkan12Device() {
  for (const VkImage image : images_) vkDestroyImage(device_, image, nullptr);
  for (const VkDeviceMemory memory : memories_) vkFreeMemory(device_, memory, nullptr);
  vkDestroyCommandPool(device_, pool_, nullptr);
  vkDestroyDevice(device_, nullptr);
  reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
      instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

AlcoveContextInfo Vulkan12Device::context_info() const {
  return {.struct_size = sizeof(AlcoveContextInfo),
          .instance = instance_,
          .physical_device = physical_device_,
          .device = device_,
          .get_instance_proc_addr = vkGetInstanceProcAddr,
          .frames_in_flight = 1};
}

VkDeviceMemory Vulkan12Device::allocate(const VkMemoryRequirements& needs,
                                        VkMemoryPropertyFlags flags) const {
  VkPhysicalDeviceMemoryProperties properties;
  vkGetPhysicalDeviceMemoryProperties(physical_device_, &properties);
  std::uint32_t type = 0;
  while ((needs.memoryTypeBits >> type & 1u) == 0 ||
         (properties.memoryTypes[type].propertyFlags & flags) != flags)
    ++type;
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                  type};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  EXPECT_EQ(vkAllocateMemory(device_, &info, nullptr, &memory), VK_SUCCESS);
  return memory;
}

AlcoveImage Vulkan12Device::make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                                       VkImageUsageFlags usage) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {width, height, 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .usage = usage};
  VkImage image = VK_NULL_HANDLE;
  EXPECT_EQ(vkCreateImage(device_, &info, nullptr, &image), VK_SUCCESS);
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device_, image, &needs);
  const VkDeviceMemory memory = allocate(needs, 0);
  EXPECT_EQ(vkBindImageMemory(device_, image, memory, 0), VK_SUCCESS);
  images_.push_back(image);
  memories_.push_back(memory);
  return {.image = image, .format = format, .width = width, .height = height, .usage = usage};
}

void Vulkan12Device::run(const std::function<void(VkCommandBuffer)>& record) {
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool_,
                                         .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                         .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  EXPECT_EQ(vkAllocateCommandBuffers(device_, &info, &commands), VK_SUCCESS);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  vkBeginCommandBuffer(commands, &begin);
  record(commands);
  EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  const VkSubmitInfo submission{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &commands};
  EXPECT_EQ(vkQueueSubmit(queue_, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
  EXPECT_EQ(vkQueueWaitIdle(queue_), VK_SUCCESS);
  vkFreeCommandBuffers(device_, pool_, 1, &commands);
}

std::vector<unsigned char> Vulkan12Device::read(const AlcoveImage& image,
                                                std::uint32_t bytes_per_pixel) {
  const VkDeviceSize size = VkDeviceSize{image.width} * image.height * bytes_per_pixel;
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = size,
                                .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  VkBuffer buffer = VK_NULL_HANDLE;
  EXPECT_EQ(vkCreateBuffer(device_, &info, nullptr, &buffer), VK_SUCCESS);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device_, buffer, &needs);
  const VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  EXPECT_EQ(vkBindBufferMemory(device_, buffer, memory, 0), VK_SUCCESS);
  run([&](VkCommandBuffer commands) {
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {image.width, image.height, 1}};
    vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1,
                           &region);
  });
  void* mapped = nullptr;
  EXPECT_EQ(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
  const auto* bytes = static_cast<const unsigned char*>(mapped);
  std::vector<unsigned char> result(bytes, bytes + size);
  vkDestroyBuffer(device_, buffer, nullptr);
  vkFreeMemory(device_, memory, nullptr);
  return result;
}

}  // namespace alcove::passes
