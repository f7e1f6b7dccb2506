#include "commands/dispatch_cost.h"

#include <array>
#include <vector>

#include "spirv/empty.h"
#include "support/median.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kDispatches = 256;  // of a pass
constexpr std::uint32_t kRuns = 20;

// A pipeline that does nothing. Its handles are null until they are created.
struct EmptyPipeline {
  explicit EmptyPipeline(VkDevice of) : device(of) {}
  ~EmptyPipeline() {
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyShaderModule(device, module, nullptr);
  }
  EmptyPipeline(const EmptyPipeline&) = delete;
  EmptyPipeline& operator=(const EmptyPipeline&) = delete;

  VkResult create() {
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

  VkDevice device;
  VkShaderModule module = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

void record(VkCommandBuffer commands, VkPipeline pipeline, bool barriers) {
  const VkMemoryBarrier2 written{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .memoryBarrierCount = 1,
                                    .pMemoryBarriers = &written};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  for (std::uint32_t i = 0; i < kDispatches; ++i) {
    if (barriers) vkCmdPipelineBarrier2(commands, &dependency);
    vkCmdDispatch(commands, 1, 1, 1);
  }
}

}  // namespace

Result<DispatchCost> measure_dispatch_cost(Gpu& gpu) {
  EmptyPipeline empty(gpu.device().device());
  ALCOVE_TRY_VOID(check(empty.create(), "create an empty pipeline"));
  std::array<std::vector<double>, 2> microseconds;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    ALCOVE_TRY_VOID(gpu.run([&](Graph& graph) -> Result<void> {
      for (const bool barriers : {false, true}) {
        auto pass = graph.add_pass("empty dispatches");
        pass.side_effect();
        pass.record([pipeline = empty.pipeline, barriers](RecordContext& context) {
          record(context.commands, pipeline, barriers);
        });
      }
      return {};
    }));
    const auto timings = gpu.timings();
    for (std::size_t i = 0; i < timings.size(); ++i)
      microseconds.at(i).push_back(timings[i].milliseconds * 1e3 / kDispatches);
  }
  return DispatchCost{median(microseconds[0]), median(microseconds[1])};
}

}  // namespace alcove::sample
