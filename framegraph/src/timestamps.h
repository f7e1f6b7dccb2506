// GPU time of passes: two timestamps each, a query pool for each frame slot.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

class Timestamps {
 public:
  // `valid_bits`: how many bits of the queue's timestamps count, 1 to 64.
  Timestamps(const DeviceContext& device, std::uint32_t valid_bits)
      : device_(device), mask_(~std::uint64_t{0} >> (64 - valid_bits)) {}
  ~Timestamps();
  Timestamps(const Timestamps&) = delete;
  Timestamps& operator=(const Timestamps&) = delete;

  // Starts a frame of so many passes; the device has finished the last one.
  [[nodiscard]] VkResult begin_frame(VkCommandBuffer commands, std::uint32_t passes);
  // Nothing is to be read until a frame begins again.
  void forget() { count_ = 0; }
  // Announces so many passes; the number of the first. Numbers are in order of execution.
  std::uint32_t add(std::uint32_t passes) {
    count_ += passes;
    return count_ - passes;
  }
  // Different passes may be recorded at the same time.
  // `pass` is its number in the graph.
  void begin_pass(VkCommandBuffer commands, std::uint32_t number, std::uint32_t pass,
                  std::string_view name);
  void end_pass(VkCommandBuffer commands, std::uint32_t number);
  // The times of the frame that began last, once the device has finished it. Until then empty, or
  // of the frame before it with these queries; nothing is kept, so a later call is right.
  std::span<const PassTiming> read();

 private:
  struct Pass {
    std::uint32_t number = 0;
    std::string name;
  };
  const DeviceContext& device_;
  std::uint64_t mask_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::uint32_t capacity_ = 0;
  std::uint32_t count_ = 0;
  std::vector<Pass> passes_;
  std::vector<std::uint64_t> ticks_;
  std::vector<PassTiming> timings_;
};

}  // namespace alcove::framegraph
