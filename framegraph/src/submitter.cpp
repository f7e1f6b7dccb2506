#include "submitter.h"

#include <algorithm>

namespace alcove::framegraph {
namespace {

constexpr std::uint8_t kEveryQueue = (1u << kQueueClasses) - 1;

// Returns the first (or last) submission of a queue class. If the class runs nothing in this frame,
// returns the first (or last) submission of the frame.
std::uint32_t outermost(const Plan& plan, QueueClass queue, bool first) {
  const auto count = static_cast<std::uint32_t>(plan.submissions.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t index = first ? i : count - 1 - i;
    if (plan.submissions[index].queue == queue) return index;
  }
  return first ? 0 : count - 1;
}

}  // namespace

Submitter::~Submitter() {
  const VkDevice device = device_.handles.device;
  // According to Vulkan's specification, a semaphore may be destroyed once its last value has been
  // waited for. Software drivers may still use it at that time, so that the queue must also be
  // idle.
  for (std::size_t q = 0; q < kQueueClasses; ++q)
    if (values_[q] != 0) device_.vk.vkQueueWaitIdle(device_.handles.queues[q].queue);
  for (Slot& slot : slots_)
    for (SlotQueue& queue : slot.queues) queue.buffers.destroy(device_);
  for (const VkSemaphore semaphore : semaphores_)
    device_.vk.vkDestroySemaphore(device, semaphore, device_.callbacks());
}

VkResult Submitter::wait(std::uint32_t slot) {
  VkSemaphore semaphores[kQueueClasses];
  std::uint64_t values[kQueueClasses];
  VkSemaphoreWaitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
  info.pSemaphores = semaphores;
  info.pValues = values;
  for (std::size_t q = 0; q < kQueueClasses; ++q) {
    const std::uint64_t value = slots_[slot].queues[q].value;
    if (value == 0) continue;
    semaphores[info.semaphoreCount] = semaphores_[q];
    values[info.semaphoreCount++] = value;
  }
  if (info.semaphoreCount == 0) return VK_SUCCESS;
  return device_.vk.vkWaitSemaphores(device_.handles.device, &info, ~std::uint64_t{0});
}

VkResult Submitter::prepare(std::uint32_t slot) {
  for (std::size_t q = 0; q < kQueueClasses; ++q) {
    if (device_.limits.queue_families[q] == kNone) continue;
    if (semaphores_[q] == VK_NULL_HANDLE) {
      const VkSemaphoreTypeCreateInfo type{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                           .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
      const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                       .pNext = &type};
      const VkResult result = device_.vk.vkCreateSemaphore(device_.handles.device, &info,
                                                           device_.callbacks(), &semaphores_[q]);
      if (result != VK_SUCCESS) return result;
    }
    if (const VkResult result = slots_[slot].queues[q].buffers.take_back(device_)) return result;
  }
  return VK_SUCCESS;
}

VkResult Submitter::submit(const Plan& plan, const FrameInfo& info) {
  const bool several =
      std::any_of(plan.submissions.begin(), plan.submissions.end(),
                  [](const Submission& s) { return s.queue != QueueClass::graphics; });
  std::copy(std::begin(values_), std::end(values_), std::begin(before_));
  std::copy(std::begin(values_), std::end(values_), std::begin(next_values_));
  submissions_.clear();
  semaphore_infos_.clear();
  bool begun[kQueueClasses] = {};
  VkResult result = VK_SUCCESS;
  for (std::uint32_t i = 0; i < plan.submissions.size() && result == VK_SUCCESS; ++i) {
    const Submission& submission = plan.submissions[i];
    // Work that another queue waits for is submitted before that queue is given the wait.
    for (std::uint32_t w = 0; w < submission.wait_count && result == VK_SUCCESS; ++w) {
      const SubmissionInfo& awaited =
          submissions_[plan.waits[submission.first_wait + w].submission];
      if (awaited.pending && awaited.queue != queue_of(submission)) result = flush(awaited.queue);
    }
    bool& own = begun[static_cast<std::size_t>(submission.queue)];
    submissions_.push_back({});
    submissions_.back().first_semaphore = static_cast<std::uint32_t>(semaphore_infos_.size());
    // If the previous frame had another plan, this frame begins after that frame is done.
    const bool joins = full_barrier_ && !own && (several || several_before_);
    add_waits(plan, i, joins ? kEveryQueue : submission.frame_before);
    describe(plan, i, info);
    own = true;
  }
  for (std::size_t i = 0; i < submissions_.size() && result == VK_SUCCESS; ++i)
    if (submissions_[i].pending) result = flush(submissions_[i].queue);
  // After an error, work of the frame before may still be the last one of a queue.
  several_before_ = several || (several_before_ && result != VK_SUCCESS);
  for (std::size_t q = 0; q < kQueueClasses; ++q) slots_[info.slot].queues[q].value = values_[q];
  return result;
}

VkResult Submitter::record(const Plan& plan, Recorder& recorder, std::uint32_t slot,
                           Timestamps* const* timestamps, bool full_barrier) {
  submitted_ = 0;
  full_barrier_ = full_barrier;
  if (const VkResult result = prepare(slot)) return result;
  recorded_.assign(plan.submissions.size(), VK_NULL_HANDLE);
  bool begun[kQueueClasses] = {};
  for (std::uint32_t i = 0; i < plan.submissions.size(); ++i) {
    const Submission& submission = plan.submissions[i];
    const auto q = static_cast<std::size_t>(submission.queue);
    VkCommandBuffer& buffer = recorded_[i];
    CommandBuffers& buffers = slots_[slot].queues[q].buffers;
    if (const VkResult result = buffers.next(device_, submission.queue, buffer)) return result;
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (const VkResult result = device_.vk.vkBeginCommandBuffer(buffer, &begin)) return result;
    if (!begun[q] && timestamps[q]) {
      const auto passes = static_cast<std::uint32_t>(plan.passes.size());
      if (const VkResult result = timestamps[q]->begin_frame(buffer, passes)) return result;
    }
    if (!begun[q] && full_barrier) recorder.full_barrier(buffer);
    recorder.submission(i, buffer, timestamps[q]);
    if (const VkResult result = device_.vk.vkEndCommandBuffer(buffer)) return result;
    begun[q] = true;
  }
  return VK_SUCCESS;
}

void Submitter::add_waits(const Plan& plan, std::uint32_t index, std::uint8_t queues_before) {
  const Submission& submission = plan.submissions[index];
  const auto add = [this](std::size_t queue, std::uint64_t value, VkPipelineStageFlags2 stages) {
    semaphore_infos_.push_back(
        {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, semaphores_[queue], value, stages, 0});
  };
  for (std::size_t q = 0; q < kQueueClasses; ++q)
    if ((queues_before & (1u << q)) != 0 && before_[q] != 0)
      add(q, before_[q], VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
    const Wait& wait = plan.waits[submission.first_wait + w];
    const SubmissionInfo& awaited = submissions_[wait.submission];
    add(static_cast<std::size_t>(awaited.queue_class), awaited.value, wait.stages);
  }
}

void Submitter::describe(const Plan& plan, std::uint32_t index, const FrameInfo& info) {
  const Submission& submission = plan.submissions[index];
  const auto own = static_cast<std::size_t>(submission.queue);
  SubmissionInfo& described = submissions_[index];
  const auto add_external = [&](std::span<const QueueSemaphore> semaphores, bool first) {
    for (const QueueSemaphore& s : semaphores) {
      if (outermost(plan, s.queue, first) != index) continue;
      semaphore_infos_.push_back(
          {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, s.semaphore, s.value, s.stages, 0});
    }
    return static_cast<std::uint32_t>(semaphore_infos_.size()) - described.first_semaphore;
  };
  described.waits = add_external(info.waits, true);
  // Earlier submissions of this queue that are described but not yet passed to vkQueueSubmit2 will
  // also raise the semaphore's value.
  described.value = ++next_values_[own];
  semaphore_infos_.push_back({VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, semaphores_[own],
                              described.value, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0});
  described.signals = add_external(info.signals, false) - described.waits;
  described.commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  described.commands.commandBuffer = recorded_[index];
  described.queue = queue_of(submission);
  described.queue_class = submission.queue;
}

VkResult Submitter::flush(VkQueue queue) {
  infos_.clear();
  const auto is_ready = [queue](const SubmissionInfo& d) { return d.pending && d.queue == queue; };
  for (const SubmissionInfo& d : submissions_) {
    if (!is_ready(d)) continue;
    const VkSemaphoreSubmitInfo* const semaphores = semaphore_infos_.data() + d.first_semaphore;
    infos_.push_back({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                      .waitSemaphoreInfoCount = d.waits,
                      .pWaitSemaphoreInfos = semaphores,
                      .commandBufferInfoCount = 1,
                      .pCommandBufferInfos = &d.commands,
                      .signalSemaphoreInfoCount = d.signals,
                      .pSignalSemaphoreInfos = semaphores + d.waits});
  }
  const VkResult result = device_.vk.vkQueueSubmit2(
      queue, static_cast<std::uint32_t>(infos_.size()), infos_.data(), VK_NULL_HANDLE);
  if (result != VK_SUCCESS) return result;
  for (SubmissionInfo& d : submissions_) {
    if (!is_ready(d)) continue;
    d.pending = false;
    values_[static_cast<std::size_t>(d.queue_class)] = d.value;
    ++submitted_;
  }
  return VK_SUCCESS;
}

}  // namespace alcove::framegraph
