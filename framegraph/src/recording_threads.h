// Records a plan's submissions: by one thread into the command buffer itself, or by several into
// secondary command buffers that it executes in order.
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
  // `threads` counts the caller's: 1 makes none. Fewer where the system does not give them.
  RecordingThreads(const DeviceContext& device, Pool& pool, std::uint32_t threads,
                   std::uint32_t slots);
  ~RecordingThreads();
  RecordingThreads(const RecordingThreads&) = delete;
  RecordingThreads& operator=(const RecordingThreads&) = delete;

  // Sets the frame that the next calls record. The device has finished the last frame of its slot.
  [[nodiscard]] VkResult begin(const RecordedFrame& frame);
  void full_barrier(VkCommandBuffer commands) { recorders_[0]->full_barrier(commands); }
  // On an error nothing is recorded. An exception of any thread is thrown here, after all have
  // finished.
  [[nodiscard]] VkResult submission(const Submission& submission, VkCommandBuffer commands,
                                    Timestamps* timestamps);
  // The errors of callbacks since begin(), which are forgotten then.
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
  bool together_ = false;  // whether several threads record this frame

  // The job in hand. The threads read it while `round_` has just moved on and `busy_` is not 0.
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
