// Texel sizes and aspects of formats.
#pragma once

#include <cstdint>

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Bytes of a texel (of a 4x4 block for compressed formats, averaged to 1 byte a texel); 16 for
// formats that are not listed: an estimate must not be too small.
std::uint32_t texel_size(VkFormat format);
// All aspects of the format, as barriers name them.
VkImageAspectFlags aspects(VkFormat format);
// The aspect that a view shows: depth for depth formats.
VkImageAspectFlags view_aspect(VkFormat format);

}  // namespace alcove::framegraph
