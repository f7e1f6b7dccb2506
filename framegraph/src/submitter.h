// Hands recorded submissions to the queues, ordered by one timeline semaphore for each queue class.
#pragma once

#include <cstdint>
#include <vector>

#include "command_buffers.h"
#include "device_context.h"
#include "recording_threads.h"

namespace alcove::framegraph {

class Submitter {
 public:
  Submitter(const DeviceContext& device, std::uint32_t slots) : device_(device), slots_(slots) {}
  ~Submitter();
  Submitter(const Submitter&) = delete;
  Submitter& operator=(const Submitter&) = delete;

  // Waits until the device has finished what was submitted with this slot.
  [[nodiscard]] VkResult wait(std::uint32_t slot);
  // Records and submits a plan that `recording_threads` was begun with. `timestamps` is by queue
  // class, null where there are none. `full_barrier`: memory holds what another plan left.
  [[nodiscard]] VkResult submit(const Plan& plan, RecordingThreads& recording_threads,
                                std::uint32_t slot, Timestamps* const* timestamps,
                                bool full_barrier);
  // Whether submit handed over some of a frame and then failed.
  bool stopped_midway() const { return submitted_ != 0; }

 private:
  struct SlotQueue {
    CommandBuffers buffers;
    std::uint64_t value = 0;  // of the queue's semaphore once the slot's last frame is done
  };
  struct Slot {
    SlotQueue queues[kQueueClasses];
  };

  VkResult prepare(std::uint32_t slot);
  VkResult record(const Plan& plan, RecordingThreads& recording_threads, std::uint32_t slot,
                  Timestamps* const* timestamps, bool full_barrier);
  VkResult submit_one(const Plan& plan, std::uint32_t index, bool join);

  const DeviceContext& device_;
  std::vector<Slot> slots_;
  VkSemaphore semaphores_[kQueueClasses] = {};
  std::uint64_t values_[kQueueClasses] = {};  // last value that will be signalled
  std::uint64_t before_[kQueueClasses] = {};  // the same at the end of the frame before
  std::vector<std::uint64_t> signalled_;      // by submission of this frame
  std::vector<VkCommandBuffer> recorded_;     // by submission of this frame
  std::uint32_t submitted_ = 0;               // submissions of this frame handed over
  std::vector<VkSemaphoreSubmitInfo> waits_;
  bool several_before_ = false;
};

}  // namespace alcove::framegraph
