// Values and images that passes give to their shaders.
#pragma once

#include <cstdint>

#include "alcove/passes/work.h"
#include "maths/normal_encoding.h"

namespace alcove::passes {

// Returns the value of a specialisation constant that turns a part of a shader on or off.
[[nodiscard]] constexpr std::uint32_t flag(bool on) { return on ? 1 : 0; }

// Returns the value of a specialisation constant that selects a channel of a texture. If the
// texture is not read, the value is 0: all settings of the channel then share one pipeline.
[[nodiscard]] constexpr std::uint32_t channel_if(bool read, std::uint32_t channel) {
  return read ? channel : 0;
}

// Returns `texture`, or `instead` if it is null. Every binding needs an image of its type, even if
// the shader does not use it.
[[nodiscard]] constexpr framegraph::Texture or_else(framegraph::Texture texture,
                                                    framegraph::Texture instead) {
  return texture.index != framegraph::kNone ? texture : instead;
}

// Returns the texture that the caller gave for a result, or a new transient if it gave none.
[[nodiscard]] inline framegraph::Texture given_or_added(WorkList& list, framegraph::Texture given,
                                                        const char* name, VkFormat format,
                                                        VkExtent2D size) {
  return given ? given : list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, format, size);
}

// Returns `texture`, or a new one of one texel that the shader does not write. What a shader can
// write must not be bound twice.
[[nodiscard]] inline framegraph::Texture or_unused(WorkList& list, framegraph::Texture texture,
                                                   VkFormat format) {
  return given_or_added(list, texture, "unused output", format, {1, 1});
}

// Returns the variant of a shader with bent normals and with a GGX lobe. In the enum the shader is
// followed by those with BENT, with SPECULAR and with both.
[[nodiscard]] constexpr Shader variant(Shader shader, bool bent, bool specular) {
  return static_cast<Shader>(static_cast<int>(shader) + (bent ? 1 : 0) + (specular ? 2 : 0));
}

// Returns the format in which a depth texture was first stored: `given`, or that of the texture.
[[nodiscard]] inline VkFormat stored_format(const WorkList& list, framegraph::Texture depth,
                                            VkFormat given) {
  return given != VK_FORMAT_UNDEFINED ? given : list.format(depth);
}

// Returns the value of the specialisation constant kNormalEncoding for normals that may be null.
[[nodiscard]] inline std::uint32_t encoding_of(framegraph::Texture normals,
                                               NormalEncoding encoding) {
  return normals ? static_cast<std::uint32_t>(encoding) : maths::kNoNormals;
}

}  // namespace alcove::passes
