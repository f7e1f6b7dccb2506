// Creates a second device on the physical device of a Gpu, with other features and extensions.
#pragma once

#include <vector>

#include "gpu.h"

namespace alcove::framegraph {

class ExtraDevice {
 public:
  // `features` is the pNext chain of VkDeviceCreateInfo.
  ExtraDevice(Gpu& gpu, const void* features, const std::vector<const char*>& extensions = {})
      : handles_(gpu.handles()) {
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = gpu.device().queue_family(),
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .ppEnabledExtensionNames = extensions.data()};
    EXPECT_EQ(vkCreateDevice(gpu.device().physical_device(), &info, nullptr, &handles_.device),
              VK_SUCCESS);
    vkGetDeviceQueue(handles_.device, queue.queueFamilyIndex, 0, &handles_.queues[0].queue);
  }
  ~ExtraDevice() { vkDestroyDevice(handles_.device, nullptr); }
  ExtraDevice(const ExtraDevice&) = delete;
  ExtraDevice& operator=(const ExtraDevice&) = delete;

  VkDevice device() const { return handles_.device; }
  const DeviceHandles& handles() const { return handles_; }

 private:
  DeviceHandles handles_;
};

}  // namespace alcove::framegraph
