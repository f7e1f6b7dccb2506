#include "events.h"

namespace alcove::framegraph {

Events::~Events() {
  for (const Slot& slot : slots_) {
    for (const VkEvent event : slot.events)
      device_.vk.vkDestroyEvent(device_.handles.device, event, nullptr);
  }
}

tl::expected<std::span<const VkEvent>, VkResult> Events::begin_frame(std::uint32_t slot,
                                                                     std::size_t count) {
  Slot& own = slots_[slot];
  for (; own.used > 0; --own.used) {
    const VkResult result =
        device_.vk.vkResetEvent(device_.handles.device, own.events[own.used - 1]);
    if (result != VK_SUCCESS) return tl::unexpected(result);
  }
  while (own.events.size() < count) {
    VkEventCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
    // Its place first: where memory gives out no event is lost.
    own.events.push_back(VK_NULL_HANDLE);
    const VkResult result =
        device_.vk.vkCreateEvent(device_.handles.device, &info, nullptr, &own.events.back());
    if (result != VK_SUCCESS) {
      own.events.pop_back();
      return tl::unexpected(result);
    }
  }
  own.used = count;
  return std::span<const VkEvent>(own.events.data(), count);
}

}  // namespace alcove::framegraph
