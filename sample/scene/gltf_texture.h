#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// Converts a glTF sampler (glTF 2.0 section 5.26). Filters that the file does not give are linear,
// also between mip levels. A value that glTF does not define is an error. The error text is the
// middle of a sentence.
[[nodiscard]] tl::expected<Sampler, std::string> read_sampler(const tinygltf::Sampler& in);

// Returns the matrix of the extension KHR_texture_transform from the mesh's texture coordinates to
// those of the image: scale, then rotation, then offset, or the identity without the extension. A
// positive rotation is counter-clockwise in the image, whose v points down. Numbers outside the
// range of a float are an error. The error text is the end of a sentence whose beginning the caller
// adds.
[[nodiscard]] tl::expected<glm::mat3x2, std::string> texture_transform(
    const tinygltf::ExtensionMap& extensions);

// Returns the index of the set of texture coordinates: `set`, unless the extension names another.
[[nodiscard]] int coordinate_set(int set, const tinygltf::ExtensionMap& extensions);

}  // namespace alcove::sample
