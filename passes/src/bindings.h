// What passes give to shaders beside their parameters.
#pragma once

#include <cstdint>

#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// A constant that turns part of a shader on.
[[nodiscard]] constexpr std::uint32_t flag(bool on) { return on ? 1 : 0; }

// A constant that picks the channel of a texture; where that is not read all channels are one
// pipeline.
[[nodiscard]] constexpr std::uint32_t channel_if(bool read, std::uint32_t channel) {
  return read ? channel : 0;
}

// The view of a texture; where it is null and so not read, or not written, that of `instead`, which
// is of its kind.
[[nodiscard]] inline VkImageView view_or(const framegraph::RecordContext& context,
                                         framegraph::Texture texture, framegraph::Texture instead) {
  return context.view(texture ? texture : instead);
}

}  // namespace alcove::passes
