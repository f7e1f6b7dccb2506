#include "submitter.h"

#include <algorithm>

namespace alcove::framegraph {

Submitter::~Submitter() {
  const VkDevice device = device_.handles.device;
  // Waiting for a semaphore's value is enough by the letter, but a software driver may still be
  // letting go of the semaphore then: an idle queue has let go of everything.
  for (std::size_t q = 0; q < kQueueClasses; ++q) {
    if (values_[q] != 0) device_.vk.vkQueueWaitIdle(device_.handles.queues[q].queue);
  }
  for (Slot& slot : slots_) {
    for (SlotQueue& queue : slot.queues) queue.buffers.destroy(device_);
  }
  for (const VkSemaphore semaphore : semaphores_)
    device_.vk.vkDestroySemaphore(device, semaphore, nullptr);
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
      VkSemaphoreTypeCreateInfo type{};
      type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
      type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
      VkSemaphoreCreateInfo info{};
      info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
      info.pNext = &type;
      const VkResult result =
          device_.vk.vkCreateSemaphore(device_.handles.device, &info, nullptr, &semaphores_[q]);
      if (result != VK_SUCCESS) return result;
    }
    if (const VkResult result = slots_[slot].queues[q].buffers.take_back(device_)) return result;
  }
  return VK_SUCCESS;
}

VkResult Submitter::submit(const Plan& plan, RecordingThreads& recording_threads,
                           std::uint32_t slot, Timestamps* const* timestamps, bool full_barrier) {
  submitted_ = 0;
  if (const VkResult result = prepare(slot)) return result;
  // All is recorded before anything runs: what fails while recording leaves the device untouched.
  if (const VkResult result = record(plan, recording_threads, slot, timestamps, full_barrier))
    return result;
  const bool several =
      std::any_of(plan.submissions.begin(), plan.submissions.end(),
                  [](const Submission& s) { return s.queue != QueueClass::graphics; });
  std::copy(std::begin(values_), std::end(values_), std::begin(before_));
  signalled_.assign(plan.submissions.size(), 0);
  bool begun[kQueueClasses] = {};
  VkResult result = VK_SUCCESS;
  for (; submitted_ < plan.submissions.size(); ++submitted_) {
    bool& own = begun[static_cast<std::size_t>(plan.submissions[submitted_].queue)];
    result = submit_one(plan, submitted_, !own && (several || several_before_));
    if (result != VK_SUCCESS) break;
    own = true;
  }
  several_before_ = several;
  for (std::size_t q = 0; q < kQueueClasses; ++q) slots_[slot].queues[q].value = values_[q];
  return result;
}

VkResult Submitter::record(const Plan& plan, RecordingThreads& recording_threads,
                           std::uint32_t slot, Timestamps* const* timestamps, bool full_barrier) {
  recorded_.assign(plan.submissions.size(), VK_NULL_HANDLE);
  bool begun[kQueueClasses] = {};
  for (std::uint32_t i = 0; i < plan.submissions.size(); ++i) {
    const Submission& submission = plan.submissions[i];
    const auto q = static_cast<std::size_t>(submission.queue);
    VkCommandBuffer& buffer = recorded_[i];
    CommandBuffers& buffers = slots_[slot].queues[q].buffers;
    if (const VkResult result =
            buffers.next(device_, submission.queue, VK_COMMAND_BUFFER_LEVEL_PRIMARY, buffer))
      return result;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult result = device_.vk.vkBeginCommandBuffer(buffer, &begin)) return result;
    if (!begun[q] && timestamps[q]) {
      const auto passes = static_cast<std::uint32_t>(plan.passes.size());
      if (const VkResult result = timestamps[q]->begin_frame(buffer, passes)) return result;
    }
    if (!begun[q] && full_barrier) recording_threads.full_barrier(buffer);
    if (const VkResult result = recording_threads.submission(submission, buffer, timestamps[q]))
      return result;
    if (const VkResult result = device_.vk.vkEndCommandBuffer(buffer)) return result;
    begun[q] = true;
  }
  return VK_SUCCESS;
}

VkResult Submitter::submit_one(const Plan& plan, std::uint32_t index, bool join) {
  const Submission& submission = plan.submissions[index];
  const auto own = static_cast<std::size_t>(submission.queue);
  waits_.clear();
  const auto add_wait = [this](std::size_t queue, std::uint64_t value, VkPipelineStageFlags2 at) {
    VkSemaphoreSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    info.semaphore = semaphores_[queue];
    info.value = value;
    info.stageMask = at;
    waits_.push_back(info);
  };
  for (std::size_t q = 0; q < kQueueClasses && join; ++q) {
    if (before_[q] != 0) add_wait(q, before_[q], VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  }
  for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
    const Wait& wait = plan.waits[submission.first_wait + w];
    add_wait(static_cast<std::size_t>(plan.submissions[wait.submission].queue),
             signalled_[wait.submission], wait.stages);
  }
  VkSemaphoreSubmitInfo signal{};
  signal.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  signal.semaphore = semaphores_[own];
  signal.value = values_[own] + 1;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkCommandBufferSubmitInfo commands{};
  commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  commands.commandBuffer = recorded_[index];
  VkSubmitInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits_.size());
  info.pWaitSemaphoreInfos = waits_.data();
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &signal;
  const VkResult result =
      device_.vk.vkQueueSubmit2(device_.handles.queues[own].queue, 1, &info, VK_NULL_HANDLE);
  if (result != VK_SUCCESS) return result;
  signalled_[index] = ++values_[own];
  return VK_SUCCESS;
}

}  // namespace alcove::framegraph
