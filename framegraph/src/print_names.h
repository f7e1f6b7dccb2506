// Returns short names of stages, accesses, usages, layouts and formats.
#pragma once

#include <string>
#include <vector>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Returns the names of the bits, joined by '|', or "none" if no bit is set.
std::string stage_names(VkPipelineStageFlags2 stages);
std::string usage_names(ResourceKind kind, VkFlags usage);
std::string layout_name(VkImageLayout layout);
std::string queue_name(QueueClass queue);
std::string byte_size(VkDeviceSize bytes);
// Returns a text such as "mip 0..2 layer 1", or an empty one if the range covers the whole texture.
std::string range_name(const Range& range, std::uint32_t mips, std::uint32_t layers);
// Returns the names of all resources. If several resources have the same name, each is followed by
// the index of the resource.
std::vector<std::string> resource_names(const GraphDescription& graph);
// Returns the reason why a pass runs, for example "for 'lighting'", or why it was culled.
std::string reason(const GraphDescription& graph, const PassCullReason& cull_reason);

}  // namespace alcove::framegraph
