// The events of split barriers, by frame slot: reset by the host once the device has finished the
// slot's last frame.
#pragma once

#include <span>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

class Events {
 public:
  Events(const DeviceContext& device, std::uint32_t slots) : device_(device), slots_(slots) {}
  ~Events();
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  // So many events of a slot, none of them set; valid until its next frame.
  [[nodiscard]] tl::expected<std::span<const VkEvent>, VkResult> begin_frame(std::uint32_t slot,
                                                                             std::size_t count);

 private:
  struct Slot {
    std::vector<VkEvent> events;
    std::size_t used = 0;
  };
  const DeviceContext& device_;
  std::vector<Slot> slots_;
};

}  // namespace alcove::framegraph
