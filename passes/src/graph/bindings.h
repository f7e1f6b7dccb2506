// Values that passes give to their shaders in addition to the parameters.
#pragma once

#include <cstdint>

#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// Returns the value of a specialisation constant that turns a part of a shader on or off.
[[nodiscard]] constexpr std::uint32_t flag(bool on) { return on ? 1 : 0; }

// Returns the value of a specialisation constant that selects a channel of a texture. If the
// texture is not read, the value is 0: all settings of the channel then share one pipeline.
[[nodiscard]] constexpr std::uint32_t channel_if(bool read, std::uint32_t channel) {
  return read ? channel : 0;
}

// Returns the view of `texture`, or the view of `instead` if `texture` is null. Every binding needs
// a view of its type, even if the shader does not use it.
[[nodiscard]] inline VkImageView view_or(const framegraph::RecordContext& context,
                                         framegraph::Texture texture, framegraph::Texture instead) {
  return context.view(texture ? texture : instead);
}

}  // namespace alcove::passes
