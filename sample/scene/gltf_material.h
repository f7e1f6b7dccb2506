#pragma once

#include <tiny_gltf.h>

#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// Adds the materials of a model. The last one is a default for primitives without a material.
// TextureUse::image indexes the images of the model, until add_images() decodes them. Textures that
// use a third or later set of coordinates, and samplers with values unknown to glTF are left out
// with a warning: an image reads as white, a normal map has no effect, and a sampler has linear
// filters. References to missing elements, and numbers that are not finite are errors.
[[nodiscard]] Result<void> add_materials(const tinygltf::Model& model, Scene& scene);

}  // namespace alcove::sample
