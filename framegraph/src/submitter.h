// Submits recorded work to the queues, ordered by one timeline semaphore for each queue class.
#pragma once

#include <cstdint>
#include <vector>

#include "command_buffers.h"
#include "device_context.h"
#include "recorder.h"

namespace alcove::framegraph {

class Submitter {
 public:
  Submitter(const DeviceContext& device, std::uint32_t slots) : device_(device), slots_(slots) {}
  ~Submitter();
  Submitter(const Submitter&) = delete;
  Submitter& operator=(const Submitter&) = delete;

  // Waits until the device has finished the frame that was last submitted with this slot.
  [[nodiscard]] VkResult wait(std::uint32_t slot);
  // Records the plan with which the recorder was begun. `timestamps` is an array, not null, with
  // one element per queue class. An element is null if its queue has no timestamps. If
  // `full_barrier` is true, the frame begins with a barrier over everything, because another plan
  // used the memory before.
  [[nodiscard]] VkResult record(const Plan& plan, Recorder& recorder, std::uint32_t slot,
                                Timestamps* const* timestamps, bool full_barrier);
  // Submits the frame that was recorded last.
  [[nodiscard]] VkResult submit(const Plan& plan, const FrameInfo& info);
  // Returns whether submit() failed after it had submitted a part of the frame.
  bool stopped_midway() const { return submitted_ != 0; }

 private:
  struct SlotQueue {
    CommandBuffers buffers;
    std::uint64_t value = 0;  // the queue's semaphore value after the slot's last frame
  };
  struct Slot {
    SlotQueue queues[kQueueClasses];
  };

  VkResult prepare(std::uint32_t slot);
  // Adds the semaphore waits of a submission. `queues_before` has one bit per queue class: the
  // submission waits for the work of the previous frame on these queues.
  void add_waits(const Plan& plan, std::uint32_t index, std::uint8_t queues_before);
  // Describes a submission. flush() submits the described submissions of a queue.
  void describe(const Plan& plan, std::uint32_t index, const FrameInfo& info);
  VkResult flush(VkQueue queue);
  VkQueue queue_of(const Submission& submission) const {
    return device_.handles.queues[static_cast<std::size_t>(submission.queue)].queue;
  }

  // A submission that is described and not yet submitted.
  struct SubmissionInfo {
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t first_semaphore = 0;  // into semaphore_infos_: waits, then signals
    std::uint32_t waits = 0;
    std::uint32_t signals = 0;
    VkCommandBufferSubmitInfo commands{};
    std::uint64_t value = 0;  // the semaphore value of its queue class after it is done
    QueueClass queue_class = QueueClass::graphics;
    bool pending = true;
  };

  const DeviceContext& device_;
  std::vector<Slot> slots_;
  VkSemaphore semaphores_[kQueueClasses] = {};
  std::uint64_t values_[kQueueClasses] = {};       // last value that will be signalled
  std::uint64_t next_values_[kQueueClasses] = {};  // with the described submissions
  std::uint64_t before_[kQueueClasses] = {};       // values_ at the end of the previous frame
  std::vector<VkCommandBuffer> recorded_;          // by submission of this frame
  std::uint32_t submitted_ = 0;                    // submissions of this frame handed over
  std::vector<SubmissionInfo> submissions_;        // by submission of this frame
  std::vector<VkSemaphoreSubmitInfo> semaphore_infos_;
  std::vector<VkSubmitInfo2> infos_;  // of one vkQueueSubmit2
  bool several_before_ = false;
  bool full_barrier_ = false;
};

}  // namespace alcove::framegraph
