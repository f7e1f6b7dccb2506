// Short names for stages, accesses, usages, layouts and formats.
#pragma once

#include <string>
#include <vector>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Bits joined by '|'; "none" for none.
std::string stage_names(VkPipelineStageFlags2 stages);
std::string access_names(VkAccessFlags2 accesses);
std::string usage_names(ResourceKind kind, VkFlags usage);
std::string layout_name(VkImageLayout layout);
std::string queue_name(QueueClass queue);
std::string byte_size(VkDeviceSize bytes);
// "mip 0..2 layer 1" where it is not everything.
std::string range_name(const Range& range, std::uint32_t mips, std::uint32_t layers);
// Names of all resources, with their index where several have the same one.
std::vector<std::string> resource_names(const GraphDescription& graph);
// Why a pass runs, "for 'lighting'", or why it does not.
std::string reason(const GraphDescription& graph, const PassCullReason& cull_reason);

}  // namespace alcove::framegraph
