// Measures the GPU time of passes with two timestamps each, in one query pool for each frame slot.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

class Timestamps {
 public:
  // `valid_bits` is the number of valid bits of the queue's timestamps, 1 to 64.
  Timestamps(const DeviceContext& device, std::uint32_t valid_bits)
      : device_(device), mask_(~std::uint64_t{0} >> (64 - valid_bits)) {}
  ~Timestamps();
  Timestamps(const Timestamps&) = delete;
  Timestamps& operator=(const Timestamps&) = delete;

  // Starts a frame with `passes` passes. The device must have finished the previous frame with
  // these queries.
  [[nodiscard]] VkResult begin_frame(VkCommandBuffer commands, std::uint32_t passes);
  // Makes read() return nothing until the next frame begins.
  void forget() { count_ = 0; }
  // Adds `passes` passes to the frame and returns the number of the first. Numbers are in order of
  // execution.
  std::uint32_t add(std::uint32_t passes) {
    count_ += passes;
    return count_ - passes;
  }
  // Begins the timing of a pass. `pass` is the index of the pass in the graph.
  void begin_pass(VkCommandBuffer commands, std::uint32_t number, std::uint32_t pass,
                  std::string_view name);
  void end_pass(VkCommandBuffer commands, std::uint32_t number);
  // Returns the times of the frame that began last. Call it after the device has finished that
  // frame. Before that, the result is empty or has the times of the previous frame with these
  // queries.
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
