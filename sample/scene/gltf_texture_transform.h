#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>

#include "support/glm.h"

namespace alcove::sample {

// The extension KHR_texture_transform of a texture reference of a material.

// Returns the matrix from the mesh's texture coordinates to those of the image: scale, then
// rotation, then offset, or the identity without the extension. A positive rotation is
// counter-clockwise in the image, whose v points down. Numbers outside the range of a float are an
// error. The error text is the end of a sentence whose beginning the caller adds.
[[nodiscard]] tl::expected<glm::mat3x2, std::string> texture_transform(
    const tinygltf::ExtensionMap& extensions);

// Returns the index of the set of texture coordinates: `set`, unless the extension names another.
[[nodiscard]] int coordinate_set(int set, const tinygltf::ExtensionMap& extensions);

}  // namespace alcove::sample
