#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// A sampler of the file (glTF 2.0 section 5.26). Filters that it does not give are linear, between
// mips too. A value unknown to glTF is an error, the middle of a sentence.
[[nodiscard]] tl::expected<Sampler, std::string> read_sampler(const tinygltf::Sampler& in);

}  // namespace alcove::sample
