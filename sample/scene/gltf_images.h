#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <vector>

#include "scene/gltf_files.h"
#include "scene/scene.h"

namespace alcove::sample {

// Limits on the images of a scene, in pixels.
struct ImageLimits {
  uint64_t kept = uint64_t{1} << 27;  // sum over all images in memory: 512 MiB
  uint64_t decoded =
      uint64_t{1} << 30;  // sum over all images before reduction: some seconds of decoding
};

// Decodes the images of a model that `used` marks into a scene. The headers of all of them are read
// first. If the images together exceed the limit on memory, large images are reduced by powers of 2
// until all fit. An image is left out if it cannot be read, if it has too many pixels a side, or if
// the images before it reach the limit on decoding. The scene gets a warning about each of these.
//
// Returns for each image of the model its index in Scene::images, or -1 without one.
[[nodiscard]] std::vector<int32_t> decode_images(const tinygltf::Model& model,
                                                 const std::vector<char>& used, GltfFiles& files,
                                                 const ImageLimits& limits, Scene& scene);

}  // namespace alcove::sample
