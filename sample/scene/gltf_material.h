#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// The model's materials, plus one default at the end for primitives that name none, and those of
// its images that a material uses. Images are taken from buffer views, or from the encoded bytes
// that the loader left in Image::image. A warning: an image that cannot be read and a texture by
// coordinates beyond the second set, which are left out (white; no normal map), and a sampler of
// values unknown to glTF. An error: more than `most_pixels` in all, a texture that does not
// exist, numbers that are not finite.
[[nodiscard]] tl::expected<void, std::string> add_materials(const tinygltf::Model& model,
                                                            uint64_t most_pixels, Scene& scene);

}  // namespace alcove::sample
