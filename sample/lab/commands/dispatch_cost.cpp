#include "commands/dispatch_cost.h"

#include <array>
#include <vector>

#include "spirv/empty.h"
#include "support/median.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kDispatches = 256;  // between two timestamps
constexpr std::uint32_t kRuns = 20;

// The objects of the measurement. Their handles are null until they are created.
struct Objects {
  explicit Objects(VkDevice of) : device(of) {}
  ~Objects() {
    vkDestroyQueryPool(device, queries, nullptr);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyShaderModule(device, module, nullptr);
  }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  VkResult create(std::uint32_t queue_family);
  VkResult create_pipeline();

  VkDevice device;
  VkShaderModule module = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE;
};

VkResult Objects::create_pipeline() {
  const VkShaderModuleCreateInfo code{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = sizeof kEmpty,
                                      .pCode = kEmpty};
  const VkPipelineLayoutCreateInfo empty{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  VkResult result = vkCreateShaderModule(device, &code, nullptr, &module);
  if (result == VK_SUCCESS) result = vkCreatePipelineLayout(device, &empty, nullptr, &layout);
  if (result != VK_SUCCESS) return result;
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main"},
      .layout = layout};
  return vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
}

VkResult Objects::create(std::uint32_t queue_family) {
  VkResult result = create_pipeline();
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = queue_family};
  if (result == VK_SUCCESS) result = vkCreateCommandPool(device, &pool_info, nullptr, &pool);
  if (result == VK_SUCCESS) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    result = vkAllocateCommandBuffers(device, &info, &commands);
  }
  if (result == VK_SUCCESS) {
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2};
    result = vkCreateQueryPool(device, &info, nullptr, &queries);
  }
  return result;
}

VkResult record(const Objects& objects, bool barriers) {
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  const VkResult result = vkBeginCommandBuffer(objects.commands, &begin);
  if (result != VK_SUCCESS) return result;
  vkCmdResetQueryPool(objects.commands, objects.queries, 0, 2);
  vkCmdBindPipeline(objects.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.pipeline);
  vkCmdWriteTimestamp2(objects.commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, objects.queries,
                       0);
  const VkMemoryBarrier2 written{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .memoryBarrierCount = 1,
                                    .pMemoryBarriers = &written};
  for (std::uint32_t i = 0; i < kDispatches; ++i) {
    if (barriers) vkCmdPipelineBarrier2(objects.commands, &dependency);
    vkCmdDispatch(objects.commands, 1, 1, 1);
  }
  vkCmdWriteTimestamp2(objects.commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, objects.queries,
                       1);
  return vkEndCommandBuffer(objects.commands);
}

}  // namespace

Result<DispatchCost> measure_dispatch_cost(const VulkanDevice& device) {
  Objects objects(device.device());
  VkResult result = objects.create(device.queue_family());
  std::array<double, 2> medians{};
  for (const bool barriers : {false, true}) {
    std::vector<double> microseconds;
    for (std::uint32_t run = 0; run < kRuns && result == VK_SUCCESS; ++run) {
      const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &objects.commands};
      std::array<std::uint64_t, 2> ticks{};
      result = record(objects, barriers);
      if (result == VK_SUCCESS) result = vkQueueSubmit(device.queue(), 1, &submit, VK_NULL_HANDLE);
      if (result == VK_SUCCESS) result = vkQueueWaitIdle(device.queue());
      if (result == VK_SUCCESS) {
        result = vkGetQueryPoolResults(device.device(), objects.queries, 0, 2, sizeof ticks,
                                       ticks.data(), sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
      }
      microseconds.push_back(static_cast<double>(ticks[1] - ticks[0]) *
                             device.properties().limits.timestampPeriod * 1e-3 / kDispatches);
    }
    medians.at(barriers ? 1 : 0) = median(microseconds);
  }
  if (result != VK_SUCCESS) return device_failure("time an empty dispatch", result);
  return DispatchCost{medians[0], medians[1]};
}

}  // namespace alcove::sample
