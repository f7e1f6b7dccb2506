#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>

#include "support/glm.h"

namespace alcove::sample {

// The extension KHR_texture_transform of a texture's use, from that use's extensions.

// Texture coordinates from the mesh's: scaled, then turned, then moved. A positive rotation is
// counter-clockwise as an image is looked at, v downwards. The identity where there is none.
// Numbers that a float does not hold are an error, the end of a sentence.
[[nodiscard]] tl::expected<glm::mat3x2, std::string> texture_transform(
    const tinygltf::ExtensionMap& extensions);

// The set of texture coordinates: `set` unless the extension names another.
[[nodiscard]] int coordinate_set(int set, const tinygltf::ExtensionMap& extensions);

}  // namespace alcove::sample
