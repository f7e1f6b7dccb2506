#include "recording_threads.h"

#include <algorithm>
#include <utility>

namespace alcove::framegraph {
namespace {

// Calls f and returns the exception that it throws, or null. In a build without exceptions the
// result is always null.
template <typename Function>
std::exception_ptr thrown_by(Function&& f) {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
  try {
    f();
  } catch (...) {
    return std::current_exception();
  }
#else
  f();
#endif
  return nullptr;
}

}  // namespace

RecordingThreads::RecordingThreads(const DeviceContext& device, Pool& pool, std::uint32_t threads,
                                   std::uint32_t slots)
    : device_(device), slots_(slots) {
  for (std::uint32_t i = 0; i < threads; ++i)
    recorders_.push_back(std::make_unique<Recorder>(device, pool));
  if (threads > 1) buffers_.resize(threads * slots_ * kQueueClasses);
  start(threads - 1);
}

// If the system cannot create more threads, the existing ones do the work.
void RecordingThreads::start(std::size_t threads) {
  threads_.reserve(threads);
  (void)thrown_by([&] {
    while (threads_.size() < threads)
      threads_.emplace_back([this, own = threads_.size() + 1] { work(own); });
  });
}

RecordingThreads::~RecordingThreads() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  for (CommandBuffers& buffers : buffers_) buffers.destroy(device_);
}

VkResult RecordingThreads::begin(const RecordedFrame& frame) {
  for (const auto& recorder : recorders_) recorder->begin(frame);
  together_ = !threads_.empty();
  slot_ = frame.slot;
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (i / kQueueClasses % slots_ != slot_) continue;
    if (const VkResult result = buffers_[i].take_back(device_)) return result;
  }
  return VK_SUCCESS;
}

VkResult RecordingThreads::submission(const Submission& submission, VkCommandBuffer commands,
                                      Timestamps* timestamps) {
  const PassRun passes{submission.first_pass, submission.pass_count, timestamps,
                       timestamps ? timestamps->add(submission.pass_count) : 0};
  Recorder& own = *recorders_[0];
  own.acquire_imports(submission, commands);
  if (!together_ || submission.pass_count < 2) {
    own.passes(passes, commands);
  } else {
    queue_ = submission.queue;
    cut(passes);
    record_together();
    recorded_.clear();
    for (Piece& piece : pieces_) {
      if (piece.thrown) std::rethrow_exception(std::exchange(piece.thrown, nullptr));
      if (piece.result != VK_SUCCESS) return piece.result;
      recorded_.push_back(piece.commands);
    }
    device_.vk.vkCmdExecuteCommands(commands, static_cast<std::uint32_t>(recorded_.size()),
                                    recorded_.data());
  }
  own.batches(submission.first_batch, submission.batch_count, commands);
  if (own.is_last(submission)) own.release_imports(commands);
  return VK_SUCCESS;
}

Errors RecordingThreads::take_errors() {
  Errors all;
  for (const auto& recorder : recorders_) {
    for (Error& error : recorder->errors()) all.push_back(std::move(error));
    recorder->errors().clear();
  }
  return all;
}

// Divides the passes into more pieces than there are threads, so that all threads stay busy even if
// some passes take longer than others.
void RecordingThreads::cut(const PassRun& passes) {
  const auto count =
      static_cast<std::uint32_t>(std::min<std::size_t>(passes.count, 2 * (threads_.size() + 1)));
  pieces_.assign(count, Piece{});
  std::uint32_t done = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    PassRun& own = pieces_[i].passes;
    own = passes;
    own.first += done;
    own.first_time += done;
    own.count = (passes.count - done) / (count - i);
    done += own.count;
  }
}

void RecordingThreads::record_together() {
  next_piece_ = 0;
  {
    const std::lock_guard lock(mutex_);
    ++round_;
    busy_ = threads_.size();
  }
  begun_.notify_all();
  record_pieces(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void RecordingThreads::work(std::size_t thread) {
  std::uint64_t round = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    begun_.wait(lock, [&] { return ends_ || round_ != round; });
    if (ends_) return;
    round = round_;
    lock.unlock();
    record_pieces(thread);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

// Records pieces until none is left. It does not throw: an exception of a callback or of operator
// new is stored, and submission() rethrows it after all threads have finished.
void RecordingThreads::record_pieces(std::size_t thread) {
  for (std::size_t i = next_piece_++; i < pieces_.size(); i = next_piece_++) {
    pieces_[i].thrown = thrown_by([&] { pieces_[i].result = record(pieces_[i], thread); });
  }
}

VkResult RecordingThreads::record(Piece& piece, std::size_t thread) {
  VkResult result =
      buffers_of(thread).next(device_, queue_, VK_COMMAND_BUFFER_LEVEL_SECONDARY, piece.commands);
  if (result != VK_SUCCESS) return result;
  VkCommandBufferInheritanceInfo inherited{};
  inherited.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  info.pInheritanceInfo = &inherited;
  result = device_.vk.vkBeginCommandBuffer(piece.commands, &info);
  if (result != VK_SUCCESS) return result;
  recorders_[thread]->passes(piece.passes, piece.commands);
  return device_.vk.vkEndCommandBuffer(piece.commands);
}

CommandBuffers& RecordingThreads::buffers_of(std::size_t thread) {
  return buffers_[(thread * slots_ + slot_) * kQueueClasses + static_cast<std::size_t>(queue_)];
}

}  // namespace alcove::framegraph
