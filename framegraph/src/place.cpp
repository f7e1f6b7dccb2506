// Placement: offsets for all transients, in heaps by the memory types that they allow.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) & ~(alignment - 1);
}

// The first offset at which nothing that is live at the same time lies.
VkDeviceSize first_fit(const Plan& plan, const std::vector<std::uint32_t>& placed,
                       const Placement& wanted) {
  VkDeviceSize offset = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::uint32_t other : placed) {
      const Placement& there = plan.placements[other];
      if (there.heap != wanted.heap) continue;
      if (there.last < wanted.first || wanted.last < there.first) continue;
      if (offset + wanted.size <= there.offset || there.offset + there.size <= offset) continue;
      offset = align_up(there.offset + there.size, wanted.alignment);
      moved = true;
    }
  }
  return offset;
}

}  // namespace

void place(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan) {
  (void)graph;
  std::vector<std::uint32_t> placed;
  for (std::uint32_t r : workspace.transients) {
    const MemoryRequirements& needed = workspace.requirements[r];
    Placement& placement = plan.placements[r];
    const auto heap = std::find_if(plan.heaps.begin(), plan.heaps.end(), [&](const Heap& h) {
      return h.memory_types == needed.memory_types;
    });
    placement.heap = static_cast<std::uint32_t>(heap - plan.heaps.begin());
    if (heap == plan.heaps.end()) plan.heaps.push_back({needed.memory_types, 0, 0, 0});
    placement.alignment = std::max(needed.alignment, limits.buffer_image_granularity);
    placement.size = align_up(needed.size, limits.buffer_image_granularity);
    Heap& into = plan.heaps[placement.heap];
    placement.offset = limits.alias ? first_fit(plan, placed, placement)
                                    : align_up(into.unaliased, placement.alignment);
    into.unaliased = align_up(into.unaliased, placement.alignment) + placement.size;
    into.size = std::max(into.size, placement.offset + placement.size);
    placed.push_back(r);
  }
}

}  // namespace alcove::framegraph
