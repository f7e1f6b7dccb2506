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

}  // namespace alcove::sample
