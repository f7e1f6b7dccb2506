// Records the submissions of a plan. One thread records into the primary command buffer directly.
// Several threads record into secondary command buffers, which the primary one then executes in
// order.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "command_buffers.h"
#include "recorder.h"

namespace alcove::framegraph {

class RecordingThreads {
 public:
  // Creates the threads. `threads` includes the caller's thread, so that 1 creates none. Fewer are
  // created if the system cannot create so many.
  RecordingThreads(const DeviceContext& device, Pool& pool, std::uint32_t threads,
                   std::uint32_t slots);
  ~RecordingThreads();
  RecordingThreads(const RecordingThreads&) = delete;
  RecordingThreads& operator=(const RecordingThreads&) = delete;

  // Sets the frame that the next calls record. The device must have finished the last frame with
  // its slot.
  [[nodiscard]] VkResult begin(const RecordedFrame& frame);
  void full_barrier(VkCommandBuffer commands) { recorders_[0]->full_barrier(commands); }
  // Records a submission. On an error nothing is recorded. If a thread throws, rethrows its
  // exception after all threads have finished.
  [[nodiscard]] VkResult submission(const Submission& submission, VkCommandBuffer commands,
                                    Timestamps* timestamps);
  // Returns the errors of callbacks since begin() and forgets them.
  Errors take_errors();

 private:
  // A run of passes that one thread records.
  struct Piece {
    PassRun passes;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    std::exception_ptr thrown;
  };

  void start(std::size_t threads);
  void work(std::size_t thread);
  void record_pieces(std::size_t thread);
  VkResult record(Piece& piece, std::size_t thread);
  CommandBuffers& buffers_of(std::size_t thread);
  void cut(const PassRun& passes);
  void record_together();

  const DeviceContext& device_;
  std::vector<std::unique_ptr<Recorder>> recorders_;  // by thread
  std::vector<CommandBuffers> buffers_;               // by thread, slot and queue class
  std::size_t slots_;
  std::size_t slot_ = 0;
  bool together_ = false;  // several threads record this frame

  // The current job. Threads read it between the moment when `round_` has increased and the moment
  // when `busy_` becomes 0.
  std::vector<Piece> pieces_;
  std::vector<VkCommandBuffer> recorded_;
  QueueClass queue_ = QueueClass::graphics;
  std::atomic<std::size_t> next_piece_ = 0;

  std::mutex mutex_;
  std::condition_variable begun_;
  std::condition_variable done_;
  std::uint64_t round_ = 0;
  std::size_t busy_ = 0;  // threads that have not finished the round
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace alcove::framegraph
