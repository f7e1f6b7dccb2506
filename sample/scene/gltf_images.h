#pragma once

#include <tiny_gltf.h>

#include <cstdint>

#include "scene/gltf_files.h"
#include "scene/scene.h"

namespace alcove::sample {

// Limits on the images of a scene, in pixels.
struct ImageLimits {
  uint64_t kept = uint64_t{1} << 27;  // sum over all images in memory: 512 MiB
  uint64_t decoded =
      uint64_t{1} << 30;  // sum over all images before reduction: some seconds of decoding
};

// Decodes the images that the materials of the scene's meshes use. Before the call,
// TextureUse::image indexes the images of the model; afterwards it indexes Scene::images, or is -1
// without an image.
//
// The headers are read first. If the images together exceed the limit on memory, the largest is
// halved until all fit. An image is left out if it cannot be read, if it has too many pixels a
// side, or if those before it reach the limit on decoding. The scene gets a warning about each of
// these.
void add_images(const tinygltf::Model& model, GltfFiles& files, const ImageLimits& limits,
                Scene& scene);

}  // namespace alcove::sample
