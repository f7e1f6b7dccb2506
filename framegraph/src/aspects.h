// Image aspects of formats.
#pragma once

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Returns all aspects of the format, as an image barrier names them.
VkImageAspectFlags aspects(VkFormat format);
// Returns the aspect that a sampled view shows: depth if the format has depth.
VkImageAspectFlags view_aspect(VkFormat format);

}  // namespace alcove::framegraph
