#include "device_allocator.h"

#include <algorithm>
#include <cstdio>

namespace alcove::framegraph {
namespace {

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

VkResult DeviceAllocator::allocate(const MemoryRequest& request, MemoryRange& range) {
  const HostServices& host = device_.handles.host;
  range = {};
  reason_.clear();
  VkResult result = VK_SUCCESS;
  const bool from_block = host.block.memory != VK_NULL_HANDLE && suits_block(request);
  if (!from_block || !allocate_in_block(request, range)) {
    if (host.memory.allocate != nullptr) {
      result = host.memory.allocate(host.memory.user, request, range);
      if (result != VK_SUCCESS) reason_ = "because the caller's function that allocates failed";
    } else if (from_block) {
      result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
      VkDeviceSize used = 0;
      for (const BlockRange& part : used_) used += part.end - part.begin;
      reason_ = "because the caller's block of " + std::to_string(host.block.size) +
                " bytes, of which " + std::to_string(used) + " are in use, has no room for " +
                std::to_string(request.requirements.size) + " more: give a larger one";
    } else {
      result = allocate_from_vulkan(request, range);
    }
  }
  if (result == VK_SUCCESS && host.log.write != nullptr) {
    char text[96];
    std::snprintf(text, sizeof text, "The render graph has allocated %.2f MiB of device memory.",
                  static_cast<double>(request.requirements.size) / (1 << 20));
    host.log.write(host.log.user, Severity::info, text);
  }
  return result;
}

void DeviceAllocator::free(const MemoryRange& range) {
  if (range.memory == VK_NULL_HANDLE) return;
  const HostServices& host = device_.handles.host;
  if (range.memory == host.block.memory) {
    const auto found = std::find_if(used_.begin(), used_.end(), [&](const BlockRange& used) {
      return used.begin == range.offset;
    });
    if (found != used_.end()) {
      used_.erase(found);
      return;
    }
  }
  if (host.memory.free != nullptr)
    host.memory.free(host.memory.user, range);
  else
    device_.vk.vkFreeMemory(device_.handles.device, range.memory, device_.callbacks());
}

// Returns whether the caller's memory block can serve this request. It never serves buffers with a
// device address, because it is not known whether the block was allocated with
// VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT.
bool DeviceAllocator::suits_block(const MemoryRequest& request) const {
  const std::uint32_t type = device_.handles.host.block.memory_type;
  return type < device_.memory.memoryTypeCount && !request.device_address &&
         (request.requirements.memoryTypeBits >> type & 1u) != 0 &&
         (device_.memory.memoryTypes[type].propertyFlags & request.required) == request.required;
}

// Allocates from the first gap of the caller's block that is large enough.
bool DeviceAllocator::allocate_in_block(const MemoryRequest& request, MemoryRange& range) {
  const MemoryBlock& block = device_.handles.host.block;
  if (used_.size() == used_.capacity()) used_.reserve(2 * used_.size() + 8);
  VkDeviceSize begin = align_up(block.offset, request.requirements.alignment);
  auto next = used_.begin();
  const auto gap_end = [&] {
    return next == used_.end() ? block.offset + block.size : next->begin;
  };
  while (begin + request.requirements.size > gap_end()) {
    if (next == used_.end()) return false;
    begin = std::max(begin, align_up(next->end, request.requirements.alignment));
    ++next;
  }
  used_.insert(next, {begin, begin + request.requirements.size});
  range = {block.memory, begin};
  return true;
}

VkResult DeviceAllocator::allocate_from_vulkan(const MemoryRequest& request, MemoryRange& range) {
  const auto suits = [&](std::uint32_t type) {
    return (device_.memory.memoryTypes[type].propertyFlags & request.preferred) ==
           request.preferred;
  };
  std::uint32_t type = kNone;
  for (std::uint32_t i = device_.memory.memoryTypeCount; i-- > 0;) {
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
  return device_.vk.vkAllocateMemory(device_.handles.device, &info, device_.callbacks(),
                                     &range.memory);
}

}  // namespace alcove::framegraph
