#include "null_device.h"

#include <cstdint>
#include <cstring>

#include "fake_handle.h"

namespace alcove::framegraph {
namespace {

// The result of functions whose arguments do not matter. The caller removes its arguments itself in
// the calling conventions of all 64-bit platforms.
VkResult VKAPI_CALL do_nothing() { return VK_SUCCESS; }

// Any function that creates one object. Each gets another handle.
VkResult VKAPI_CALL create(VkDevice /*device*/, const void* /*info*/, const void* /*callbacks*/,
                           std::uint64_t* handle) {
  static std::uint64_t last = 0;
  *handle = ++last;
  return VK_SUCCESS;
}

void VKAPI_CALL get_properties(VkPhysicalDevice /*device*/, VkPhysicalDeviceProperties* found) {
  *found = {};
  found->apiVersion = VK_API_VERSION_1_2;
  found->limits.maxImageDimension2D = 16384;
  found->limits.maxImageDimension3D = found->limits.maxImageArrayLayers = 2048;
  found->limits.bufferImageGranularity = 1;
}

void VKAPI_CALL get_memory(VkPhysicalDevice /*device*/, VkPhysicalDeviceMemoryProperties* found) {
  *found = {};
  found->memoryTypeCount = found->memoryHeapCount = 1;
}

void VKAPI_CALL get_families(VkPhysicalDevice /*device*/, std::uint32_t* count,
                             VkQueueFamilyProperties* /*families*/) {
  *count = 0;
}

void VKAPI_CALL get_format(VkPhysicalDevice /*device*/, VkFormat /*format*/,
                           VkFormatProperties* found) {
  *found = {~0u, ~0u, ~0u};
}

void VKAPI_CALL get_requirements(VkDevice /*device*/, std::uint64_t /*resource*/,
                                 VkMemoryRequirements* found) {
  *found = {65536, 256, 1};
}

PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice /*device*/, const char* name);

PFN_vkVoidFunction find(const char* name) {
  const auto is = [name](const char* other) { return std::strcmp(name, other) == 0; };
  const auto as = [](auto* function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
  if (is("vkGetDeviceProcAddr")) return as(get_device_proc);
  if (is("vkGetPhysicalDeviceProperties")) return as(get_properties);
  if (is("vkGetPhysicalDeviceMemoryProperties")) return as(get_memory);
  if (is("vkGetPhysicalDeviceQueueFamilyProperties")) return as(get_families);
  if (is("vkGetPhysicalDeviceFormatProperties")) return as(get_format);
  if (is("vkGetImageMemoryRequirements") || is("vkGetBufferMemoryRequirements"))
    return as(get_requirements);
  // The optional functions are missing. The executor then asks existing resources for their memory.
  if (std::strncmp(name, "vkGetDevice", 11) == 0 || std::strstr(name, "EXT") != nullptr)
    return nullptr;
  const bool creates =
      std::strncmp(name, "vkCreate", 8) == 0 || std::strcmp(name, "vkAllocateMemory") == 0;
  return creates ? as(create) : as(do_nothing);
}

PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice /*device*/, const char* name) {
  return find(name);
}

PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance /*instance*/, const char* name) {
  return find(name);
}

}  // namespace

DeviceHandles null_device() {
  DeviceHandles handles;
  handles.instance = fake_handle<VkInstance>();
  handles.physical_device = fake_handle<VkPhysicalDevice>();
  handles.device = fake_handle<VkDevice>();
  handles.get_instance_proc_addr = get_instance_proc;
  handles.queues[0].family = 0;
  return handles;
}

}  // namespace alcove::framegraph
