#include "timestamps.h"

#include <algorithm>

namespace alcove::framegraph {

// After a rendering with a view mask, lavapipe of Mesa 25.0 writes a timestamp for each view, also
// where the rendering has ended. The later ones are overwritten by the passes that follow, and
// those of the last pass need room. A mask has 32 bits.
constexpr std::uint32_t kSpareQueries = 31;

Timestamps::~Timestamps() {
  device_.vk.vkDestroyQueryPool(device_.handles.device, pool_, device_.callbacks());
}

VkResult Timestamps::begin_frame(VkCommandBuffer commands, std::uint32_t passes) {
  count_ = 0;
  if (passes > capacity_) {
    passes_.resize(std::max<std::size_t>(passes_.size(), passes));
    ticks_.resize(2 * std::size_t{passes});
    timings_.reserve(passes);
    device_.vk.vkDestroyQueryPool(device_.handles.device, pool_, device_.callbacks());
    pool_ = VK_NULL_HANDLE;
    capacity_ = 0;
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2 * passes + kSpareQueries};
    const VkResult result =
        device_.vk.vkCreateQueryPool(device_.handles.device, &info, device_.callbacks(), &pool_);
    if (result != VK_SUCCESS) return result;
    capacity_ = passes;
  }
  if (passes > 0) device_.vk.vkCmdResetQueryPool(commands, pool_, 0, 2 * passes);
  return VK_SUCCESS;
}

void Timestamps::begin_pass(VkCommandBuffer commands, std::uint32_t number, std::uint32_t pass,
                            std::string_view name) {
  passes_[number].number = pass;
  passes_[number].name.assign(name);
  device_.vk.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_,
                                  2 * number);
}

void Timestamps::end_pass(VkCommandBuffer commands, std::uint32_t number) {
  device_.vk.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_,
                                  2 * number + 1);
}

std::span<const PassTiming> Timestamps::read() {
  if (count_ == 0) return {};
  const VkResult result = device_.vk.vkGetQueryPoolResults(
      device_.handles.device, pool_, 0, 2 * count_, ticks_.size() * sizeof(std::uint64_t),
      ticks_.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
  if (result != VK_SUCCESS) return {};
  const double milliseconds = device_.properties.limits.timestampPeriod * 1e-6;
  timings_.clear();
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint64_t ticks = (ticks_[2 * i + 1] - ticks_[2 * i]) & mask_;
    timings_.push_back(
        {passes_[i].name, passes_[i].number, static_cast<double>(ticks) * milliseconds});
  }
  return timings_;
}

}  // namespace alcove::framegraph
