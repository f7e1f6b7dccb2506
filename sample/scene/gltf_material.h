#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "scene/gltf_images.h"
#include "scene/scene.h"

namespace alcove::sample {

// Adds the model's materials, a default one at the end for primitives that name none, and the
// images that the materials use (gltf_images.h). Warnings: images that cannot be read, textures by
// coordinates beyond the second set, and samplers of values unknown to glTF, which are all left out
// (white, no normal map, linear filters). Errors: images over the limits, references to things that
// do not exist, and numbers that are not finite.
[[nodiscard]] tl::expected<void, std::string> add_materials(const tinygltf::Model& model,
                                                            const ImageLimits& limits,
                                                            Scene& scene);

}  // namespace alcove::sample
