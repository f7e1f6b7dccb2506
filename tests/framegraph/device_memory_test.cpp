// Tests from which memory type device memory is allocated, and what happens if the host cannot see
// memory that it must see.
#include "alcove/framegraph/device_memory.h"

#include <gtest/gtest.h>

#include "fake_handle.h"

namespace alcove::framegraph {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kVisible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kTypes[] = {0, kVisible, kLocal, kLocal | kVisible};

std::uint32_t used_type = kNone;  // of the last allocation
int allocated = 0;                // ranges that are not freed
VkResult mapping = VK_SUCCESS;    // result of map()

void VKAPI_CALL get_types(VkPhysicalDevice /*device*/, VkPhysicalDeviceMemoryProperties* memory) {
  memory->memoryTypeCount = std::size(kTypes);
  for (std::uint32_t i = 0; i < std::size(kTypes); ++i)
    memory->memoryTypes[i].propertyFlags = kTypes[i];
}
VkResult VKAPI_CALL allocate(VkDevice /*device*/, const VkMemoryAllocateInfo* info,
                             const VkAllocationCallbacks* /*callbacks*/, VkDeviceMemory* memory) {
  used_type = info->memoryTypeIndex;
  ++allocated;
  *memory = fake_handle<VkDeviceMemory>();
  return VK_SUCCESS;
}
void VKAPI_CALL free_allocated(VkDevice /*device*/, VkDeviceMemory /*memory*/,
                               const VkAllocationCallbacks* /*callbacks*/) {
  --allocated;
}
VkResult VKAPI_CALL map(VkDevice /*device*/, VkDeviceMemory /*memory*/, VkDeviceSize /*offset*/,
                        VkDeviceSize /*size*/, VkMemoryMapFlags /*flags*/, void** mapped) {
  static char bytes[1];
  if (mapping == VK_SUCCESS) *mapped = bytes;
  return mapping;
}

VulkanFunctions functions() {
  VulkanFunctions vk;
  vk.vkGetPhysicalDeviceMemoryProperties = get_types;
  vk.vkAllocateMemory = allocate;
  vk.vkFreeMemory = free_allocated;
  vk.vkMapMemory = map;
  return vk;
}

TEST(DeviceMemory, IsOfTheFirstTypeWithTheRequiredAndIfPossibleThePreferredProperties) {
  const struct {
    std::uint32_t allowed;
    VkMemoryPropertyFlags required, preferred;
    std::uint32_t type;
  } cases[] = {{15, 0, kLocal, 2},       {11, 0, kLocal, 3},      {3, 0, kLocal, 0},
               {15, kVisible, 0, 1},     {13, kVisible, 0, 3},    {15, kVisible, kLocal, 3},
               {7, kVisible, kLocal, 1}, {5, kVisible, 0, kNone}, {16, 0, kLocal, kNone}};
  mapping = VK_SUCCESS;
  for (const auto& c : cases) {
    used_type = kNone;
    MemoryRange range;
    const VkResult result =
        allocate_memory(functions(), {}, {{4, 4, c.allowed}, c.required, c.preferred}, range);
    EXPECT_EQ(result, c.type == kNone ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_SUCCESS);
    EXPECT_EQ(used_type, c.type) << c.allowed;
    EXPECT_EQ(range.mapped != nullptr, result == VK_SUCCESS && c.required == kVisible);
  }
}

TEST(DeviceMemory, ThatTheHostMustSeeIsFreedIfItIsNotMapped) {
  const MemoryRequest request{{4, 4, 15}, kVisible};
  DeviceHandles handles;
  MemoryRange range;
  allocated = 0;
  mapping = VK_ERROR_OUT_OF_HOST_MEMORY;
  EXPECT_EQ(allocate_memory(functions(), handles, request, range), mapping);
  EXPECT_EQ(range.memory, VkDeviceMemory{VK_NULL_HANDLE});
  EXPECT_EQ(allocated, 0);
  // The caller's function maps nothing.
  handles.host.memory = {[](void* user, const MemoryRequest&, MemoryRange& made) {
                           made.memory = fake_handle<VkDeviceMemory>();
                           ++*static_cast<int*>(user);
                           return VK_SUCCESS;
                         },
                         [](void* user, const MemoryRange&) { --*static_cast<int*>(user); },
                         &allocated};
  EXPECT_EQ(allocate_memory(functions(), handles, request, range), VK_ERROR_MEMORY_MAP_FAILED);
  EXPECT_EQ(range.memory, VkDeviceMemory{VK_NULL_HANDLE});
  EXPECT_EQ(allocated, 0);
  EXPECT_EQ(allocate_memory(functions(), handles, {{4, 4, 15}}, range), VK_SUCCESS);
  free_memory(functions(), handles, range);
  EXPECT_EQ(allocated, 0);
}

}  // namespace
}  // namespace alcove::framegraph
