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
  EXPECT_EQ(vkCreateInstance(&instance, nullptr, &handles_.instance), VK_SUCCESS);
  reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(handles_.instance, "vkCreateDebugUtilsMessengerEXT"))(
      handles_.instance, &messenger, nullptr, &messenger_);
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(handles_.instance, &count, &handles_.physical_device);
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
  EXPECT_EQ(vkCreateDevice(handles_.physical_device, &device, nullptr, &handles_.device),
            VK_SUCCESS);
  vkGetDeviceQueue(handles_.device, 0, 0, &handles_.queue);
}

Vulkan12Device::~Vulkan12Device() {
  vkDestroyDevice(handles_.device, nullptr);
  reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(handles_.instance, "vkDestroyDebugUtilsMessengerEXT"))(
      handles_.instance, messenger_, nullptr);
  vkDestroyInstance(handles_.instance, nullptr);
}

}  // namespace alcove::passes
