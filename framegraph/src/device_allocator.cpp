#include "device_allocator.h"

#include <cstdio>

namespace alcove::framegraph {
namespace {

VkResult allocate_from_vulkan(const DeviceContext& device, const MemoryRequest& request,
                              MemoryRange& range) {
  const auto suits = [&](std::uint32_t type) {
    return (device.memory.memoryTypes[type].propertyFlags & request.preferred) == request.preferred;
  };
  std::uint32_t type = kNone;
  for (std::uint32_t i = device.memory.memoryTypeCount; i-- > 0;) {
    if (!(request.requirements.memoryTypeBits & (1u << i))) continue;
    if (type == kNone || suits(i) || !suits(type)) type = i;
  }
  if (type == kNone) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  if (request.device_address) info.pNext = &flags;
  info.allocationSize = request.requirements.size;
  info.memoryTypeIndex = type;
  return device.vk.vkAllocateMemory(device.handles.device, &info, device.callbacks(),
                                    &range.memory);
}

}  // namespace

VkResult allocate(const DeviceContext& device, const MemoryRequest& request, MemoryRange& range) {
  const HostServices& host = device.handles.host;
  range = {};
  const VkResult result = host.memory.allocate != nullptr
                              ? host.memory.allocate(host.memory.user, request, range)
                              : allocate_from_vulkan(device, request, range);
  if (result == VK_SUCCESS && host.log.write != nullptr) {
    char text[96];
    std::snprintf(text, sizeof text, "The render graph has allocated %.2f MiB of device memory.",
                  static_cast<double>(request.requirements.size) / (1 << 20));
    host.log.write(host.log.user, Severity::info, text);
  }
  return result;
}

void free(const DeviceContext& device, const MemoryRange& range) {
  if (range.memory == VK_NULL_HANDLE) return;
  const HostServices& host = device.handles.host;
  if (host.memory.free != nullptr)
    host.memory.free(host.memory.user, range);
  else
    device.vk.vkFreeMemory(device.handles.device, range.memory, device.callbacks());
}

}  // namespace alcove::framegraph
