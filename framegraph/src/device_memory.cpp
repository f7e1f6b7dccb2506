#include "alcove/framegraph/device_memory.h"

namespace alcove::framegraph {
namespace {

// Returns the index of the memory type that suits a request best, or kNone if no type suits it.
std::uint32_t memory_type(const VkPhysicalDeviceMemoryProperties& memory,
                          const MemoryRequest& request) {
  for (const VkMemoryPropertyFlags properties :
       {request.required | request.preferred, request.required})
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
      if ((request.requirements.memoryTypeBits >> type & 1u) != 0 &&
          (memory.memoryTypes[type].propertyFlags & properties) == properties)
        return type;
  return kNone;
}

bool is_host_visible(const MemoryRequest& request) {
  return (request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
}

VkResult allocate_from_vulkan(const VulkanFunctions& vk, const DeviceHandles& device,
                              const MemoryRequest& request, MemoryRange& range) {
  VkPhysicalDeviceMemoryProperties memory{};
  vk.vkGetPhysicalDeviceMemoryProperties(device.physical_device, &memory);
  const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .pNext = request.device_address ? &flags : nullptr,
                                  .allocationSize = request.requirements.size,
                                  .memoryTypeIndex = memory_type(memory, request)};
  if (info.memoryTypeIndex == kNone) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  VkResult result =
      vk.vkAllocateMemory(device.device, &info, device.host.allocation_callbacks, &range.memory);
  if (result != VK_SUCCESS || !is_host_visible(request)) return result;
  result = vk.vkMapMemory(device.device, range.memory, 0, VK_WHOLE_SIZE, 0, &range.mapped);
  if (result != VK_SUCCESS) free_memory(vk, device, range);
  return result;
}

VkResult allocate_from_caller(const MemoryFunctions& functions, const MemoryRequest& request,
                              MemoryRange& range) {
  const VkResult result = functions.allocate(functions.user, request, range);
  if (result != VK_SUCCESS || !is_host_visible(request) || range.mapped != nullptr) return result;
  functions.free(functions.user, range);
  return VK_ERROR_MEMORY_MAP_FAILED;
}

}  // namespace

VkResult allocate_memory(const VulkanFunctions& vk, const DeviceHandles& device,
                         const MemoryRequest& request, MemoryRange& range) {
  const MemoryFunctions& functions = device.host.memory;
  range = {};
  const VkResult result = functions.allocate != nullptr
                              ? allocate_from_caller(functions, request, range)
                              : allocate_from_vulkan(vk, device, request, range);
  if (result != VK_SUCCESS) range = {};
  return result;
}

void free_memory(const VulkanFunctions& vk, const DeviceHandles& device, const MemoryRange& range) {
  if (range.memory == VK_NULL_HANDLE) return;
  const MemoryFunctions& functions = device.host.memory;
  if (functions.free != nullptr)
    functions.free(functions.user, range);
  else
    vk.vkFreeMemory(device.device, range.memory, device.host.allocation_callbacks);
}

}  // namespace alcove::framegraph
