// What a pass asks of the textures that it is given.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "alcove/passes/frame.h"
#include "number_text.h"

namespace alcove::passes {

struct NamedInput {
  std::string_view name;
  framegraph::Texture texture;
};

// An error that names the first input that is missing, or not as large as the first of them.
[[nodiscard]] inline tl::expected<void, Error> check_inputs(const framegraph::Graph& graph,
                                                            std::string_view pass,
                                                            std::span<const NamedInput> inputs) {
  const auto size_text = [](VkExtent3D size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
  };
  for (const NamedInput& input : inputs) {
    if (!input.texture) {
      return tl::unexpected(Error{"The pass " + std::string(pass) + " needs a texture of " +
                                  std::string(input.name) + "; it was given none."});
    }
    const VkExtent3D size = graph.extent(input.texture);
    const VkExtent3D wanted = graph.extent(inputs.front().texture);
    if (size.width != wanted.width || size.height != wanted.height) {
      return tl::unexpected(Error{"The pass " + std::string(pass) + " was given " +
                                  std::string(input.name) + " of " + size_text(size) +
                                  " pixels and " + std::string(inputs.front().name) + " of " +
                                  size_text(wanted) + "; make them equal."});
    }
  }
  return {};
}

// What a search may be of, and so the raw occlusion that it leaves.
[[nodiscard]] inline tl::expected<void, Error> check_search(std::uint32_t tile_size,
                                                            std::uint32_t slices) {
  if (tile_size != 1 && tile_size != 2 && tile_size != 4) {
    return tl::unexpected(Error{"The resolution is divided by " + std::to_string(tile_size) +
                                "; it must be 1, 2 or 4."});
  }
  if (slices < 1 || slices > 64) {
    return tl::unexpected(
        Error{"There are " + std::to_string(slices) + " slices; there must be 1 to 64."});
  }
  return {};
}

[[nodiscard]] inline tl::expected<void, Error> check_roughness(float roughness,
                                                               std::uint32_t channel) {
  if (!(roughness >= 0.0f && roughness <= 1.0f)) {
    return tl::unexpected(
        Error{"The roughness is " + number_text(roughness) + "; it must be 0 to 1."});
  }
  if (channel > 3) {
    return tl::unexpected(Error{"The channel of the roughness is " + std::to_string(channel) +
                                "; channels are 0 to 3."});
  }
  return {};
}

}  // namespace alcove::passes
