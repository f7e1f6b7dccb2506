#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>

#include "scene/gltf_images.h"
#include "scene/scene.h"

namespace alcove::sample {

// Adds the materials of a model, and the images of those that meshes of nodes use (gltf_images.h).
// The last material is a default for primitives without one. Textures that use a third or later set
// of coordinates, and samplers with values unknown to glTF are left out with a warning: an image
// reads as white, a normal map has no effect, and a sampler has linear filters. References to
// missing elements, and numbers that are not finite are errors.
[[nodiscard]] tl::expected<void, std::string> add_materials(const tinygltf::Model& model,
                                                            GltfFiles& files,
                                                            const ImageLimits& limits,
                                                            Scene& scene);

}  // namespace alcove::sample
