// Values and images that passes give to their shaders.
#pragma once

#include <cstdint>

#include "maths/normal_encoding.h"
#include "work/describe_view.h"
#include "work/view_parameters.h"

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
[[nodiscard]] constexpr ResourceHandle or_else(ResourceHandle texture, ResourceHandle instead) {
  return texture ? texture : instead;
}

// Returns `texture`, or a new one of one texel that the shader does not write. What a shader can
// write must not be bound twice.
[[nodiscard]] inline ResourceHandle or_unused(const ViewInputs& view, ResourceHandle texture,
                                              VkFormat format) {
  return texture ? texture : view.list.add_transient("unused output", format, {1, 1});
}

// Returns the variant of a shader with bent normals and with a GGX lobe. In the enum the shader is
// followed by those with BENT, with SPECULAR and with both.
[[nodiscard]] constexpr Shader variant(Shader shader, bool bent, bool specular) {
  return static_cast<Shader>(static_cast<int>(shader) + (bent ? 1 : 0) + (specular ? 2 : 0));
}

// Returns the image of a role, or a new transient if there is none.
[[nodiscard]] inline ResourceHandle image_or_transient(const ViewInputs& view, AlcoveImageRole role,
                                                       const char* name, VkFormat format) {
  if (const ResourceHandle given = view.image(role)) return given;
  return view.list.add_transient(
      name, format,
      {view.info.output_x + view.written.width, view.info.output_y + view.written.height});
}

// Returns the value of the specialisation constant kNormalEncoding.
[[nodiscard]] inline std::uint32_t encoding_of(const ViewInputs& view) {
  return view.image(ALCOVE_IMAGE_NORMALS) ? static_cast<std::uint32_t>(view.info.normal_encoding)
                                          : maths::kNoNormals;
}

[[nodiscard]] inline NormalConvention normals_of(const ViewInputs& view) {
  return normals_of(view.info, bool(view.image(ALCOVE_IMAGE_NORMALS)));
}

// Sets the members `area`, `written` and, of a shader that writes outputs, `to_outputs` of a
// shader's parameters.
template <typename Parameters>
void set_areas(Parameters& parameters, const ViewInputs& view) {
  const AlcoveArea& written = view.written;
  const AlcoveArea& read = view.read;
  parameters.area = maths::uvec4(read.x, read.y, read.width, read.height);
  parameters.written = maths::uvec4(written.x, written.y, written.x + written.width - 1,
                                    written.y + written.height - 1);
  if constexpr (requires { parameters.to_outputs; })
    parameters.to_outputs =
        maths::ivec2(view.info.output_x, view.info.output_y) - maths::ivec2(written.x, written.y);
}

}  // namespace alcove::passes
