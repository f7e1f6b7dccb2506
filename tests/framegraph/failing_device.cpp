#include "failing_device.h"

#include <atomic>
#include <cstdint>
#include <cstring>

namespace alcove::framegraph::failing {
namespace {

std::atomic<int> failing_call = 0;
std::atomic<int> call_count = 0;
std::atomic<int> alive_count = 0;
bool is_lost = false;
int submit_count = 0;
int update_count = 0;
int wait_count = 0;
int full_count = 0;
int submissions_left = -1;  // until the device is lost; negative: it is not lost

// Wraps a creating and a destroying function of the device.
template <auto kCreate, auto kDestroy>
struct Wrapped;

template <typename Info, typename Handle,
          VkResult(VKAPI_PTR* kCreate)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                       Handle*),
          void(VKAPI_PTR* kDestroy)(VkDevice, Handle, const VkAllocationCallbacks*)>
struct Wrapped<kCreate, kDestroy> {
  static VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice device, const Info* info,
                                               const VkAllocationCallbacks* callbacks,
                                               Handle* handle) {
    if (++call_count == failing_call) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const VkResult result = kCreate(device, info, callbacks, handle);
    if (result == VK_SUCCESS) ++alive_count;
    return result;
  }
  static VKAPI_ATTR void VKAPI_CALL destroy(VkDevice device, Handle handle,
                                            const VkAllocationCallbacks* callbacks) {
    if (handle != VK_NULL_HANDLE) --alive_count;
    kDestroy(device, handle, callbacks);
  }
};

using Memory = Wrapped<&vkAllocateMemory, &vkFreeMemory>;
using Image = Wrapped<&vkCreateImage, &vkDestroyImage>;
using Buffer = Wrapped<&vkCreateBuffer, &vkDestroyBuffer>;
using View = Wrapped<&vkCreateImageView, &vkDestroyImageView>;
using Queries = Wrapped<&vkCreateQueryPool, &vkDestroyQueryPool>;
using Pool = Wrapped<&vkCreateCommandPool, &vkDestroyCommandPool>;
using DescriptorPool = Wrapped<&vkCreateDescriptorPool, &vkDestroyDescriptorPool>;
using Module = Wrapped<&vkCreateShaderModule, &vkDestroyShaderModule>;
using Semaphore = Wrapped<&vkCreateSemaphore, &vkDestroySemaphore>;

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                std::uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* callbacks,
                                                VkPipeline* pipelines) {
  if (++call_count == failing_call) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  const VkResult result =
      vkCreateComputePipelines(device, cache, count, infos, callbacks, pipelines);
  if (result == VK_SUCCESS) alive_count += static_cast<int>(count);
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                            const VkAllocationCallbacks* callbacks) {
  if (pipeline != VK_NULL_HANDLE) --alive_count;
  vkDestroyPipeline(device, pipeline, callbacks);
}

// Descriptor sets are freed with their pool.
VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device,
                                             const VkDescriptorSetAllocateInfo* info,
                                             VkDescriptorSet* sets) {
  if (++call_count == failing_call) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return vkAllocateDescriptorSets(device, info, sets);
}

VKAPI_ATTR void VKAPI_CALL update_sets(VkDevice device, std::uint32_t write_count,
                                       const VkWriteDescriptorSet* writes, std::uint32_t copy_count,
                                       const VkCopyDescriptorSet* copies) {
  ++update_count;
  vkUpdateDescriptorSets(device, write_count, writes, copy_count, copies);
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* info,
                                      VkFence fence) {
  ++submit_count;
  for (std::uint32_t i = 0; i < count; ++i)
    wait_count += static_cast<int>(info[i].waitSemaphoreInfoCount);
  if (submissions_left >= 0 && submissions_left-- == 0) is_lost = true;
  return is_lost ? VK_ERROR_DEVICE_LOST : vkQueueSubmit2(queue, count, info, fence);
}

VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
  for (std::uint32_t i = 0; i < info->memoryBarrierCount; ++i) {
    const VkMemoryBarrier2& memory = info->pMemoryBarriers[i];
    full_count += memory.srcStageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT &&
                  memory.dstStageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  }
  vkCmdPipelineBarrier2(commands, info);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_semaphores(VkDevice device, const VkSemaphoreWaitInfo* info,
                                               std::uint64_t timeout) {
  return is_lost ? VK_ERROR_DEVICE_LOST : vkWaitSemaphores(device, info, timeout);
}

// The real device must be idle before anything is destroyed.
VKAPI_ATTR VkResult VKAPI_CALL wait_idle(VkQueue queue) {
  const VkResult result = vkQueueWaitIdle(queue);
  return is_lost ? VK_ERROR_DEVICE_LOST : result;
}

PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  struct Entry {
    const char* name;
    PFN_vkVoidFunction function;
  };
#define ALCOVE_WRAP(type, made, unmade)                          \
  {made, reinterpret_cast<PFN_vkVoidFunction>(&type::create)}, { \
    unmade, reinterpret_cast<PFN_vkVoidFunction>(&type::destroy) \
  }
  const Entry entries[] = {
      ALCOVE_WRAP(Memory, "vkAllocateMemory", "vkFreeMemory"),
      ALCOVE_WRAP(Image, "vkCreateImage", "vkDestroyImage"),
      ALCOVE_WRAP(Buffer, "vkCreateBuffer", "vkDestroyBuffer"),
      ALCOVE_WRAP(View, "vkCreateImageView", "vkDestroyImageView"),
      ALCOVE_WRAP(Queries, "vkCreateQueryPool", "vkDestroyQueryPool"),
      ALCOVE_WRAP(Pool, "vkCreateCommandPool", "vkDestroyCommandPool"),
      ALCOVE_WRAP(DescriptorPool, "vkCreateDescriptorPool", "vkDestroyDescriptorPool"),
      ALCOVE_WRAP(Module, "vkCreateShaderModule", "vkDestroyShaderModule"),
      {"vkCreateComputePipelines", reinterpret_cast<PFN_vkVoidFunction>(&create_pipelines)},
      {"vkDestroyPipeline", reinterpret_cast<PFN_vkVoidFunction>(&destroy_pipeline)},
      {"vkAllocateDescriptorSets", reinterpret_cast<PFN_vkVoidFunction>(&allocate_sets)},
      {"vkUpdateDescriptorSets", reinterpret_cast<PFN_vkVoidFunction>(&update_sets)},
      ALCOVE_WRAP(Semaphore, "vkCreateSemaphore", "vkDestroySemaphore"),
      {"vkCmdPipelineBarrier2", reinterpret_cast<PFN_vkVoidFunction>(&barrier)},
      {"vkQueueSubmit2", reinterpret_cast<PFN_vkVoidFunction>(&submit)},
      {"vkWaitSemaphores", reinterpret_cast<PFN_vkVoidFunction>(&wait_semaphores)},
      {"vkQueueWaitIdle", reinterpret_cast<PFN_vkVoidFunction>(&wait_idle)},
  };
#undef ALCOVE_WRAP
  for (const Entry& entry : entries)
    if (std::strcmp(entry.name, name) == 0) return entry.function;
  return vkGetDeviceProcAddr(device, name);
}

}  // namespace

void fail_at(int call) {
  failing_call = call;
  call_count = 0;
}
void lose(bool lost) {
  is_lost = lost;
  submissions_left = -1;
}
void lose_after(int submissions) { submissions_left = submissions; }
int calls() { return call_count; }
int alive() { return alive_count; }
int descriptor_updates() { return update_count; }
int submits() { return submit_count; }
int semaphore_waits() { return wait_count; }
int full_barriers() { return full_count; }

PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr);
  return vkGetInstanceProcAddr(instance, name);
}

}  // namespace alcove::framegraph::failing
