// The aspects of formats.
#pragma once

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// All aspects of the format, as barriers name them.
VkImageAspectFlags aspects(VkFormat format);
// The aspect that a view shows: depth for depth formats.
VkImageAspectFlags view_aspect(VkFormat format);

}  // namespace alcove::framegraph
