// Short names for stages, accesses, layouts and formats.
#pragma once

#include <string>

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Bits joined by '|'; "none" for none.
std::string stage_names(VkPipelineStageFlags2 stages);
std::string access_names(VkAccessFlags2 accesses);
std::string layout_name(VkImageLayout layout);
std::string queue_name(QueueClass queue);
std::string byte_size(VkDeviceSize bytes);
// "mip 0..2 layer 1" where it is not everything.
std::string range_name(const Range& range, std::uint32_t mips, std::uint32_t layers);

}  // namespace alcove::framegraph
