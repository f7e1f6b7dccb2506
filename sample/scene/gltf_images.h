#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/scene.h"
#include "support/decode_image.h"

namespace alcove::sample {

// Limits on the images of a scene, in pixels.
struct ImageLimits {
  uint64_t kept = uint64_t{1} << 27;  // sum over all images in memory: 512 MiB
  uint64_t decoded =
      uint64_t{1} << 30;  // sum over all images before reduction: some seconds of decoding
};

// Decodes the images of a model into a scene when materials use them, each image at most once. The
// headers of all images are read first. If the images together exceed the limit, large images are
// reduced by powers of 2 until all fit, and the scene gets a warning.
class GltfImages {
 public:
  GltfImages(const tinygltf::Model& model, const ImageLimits& limits, Scene& scene);

  // Returns the index in Scene::images, or -1 for an image that cannot be read; the scene then gets
  // one warning. An image that is too large or is in a missing buffer view is an error. The error
  // text is the end of a sentence about the material that uses the image.
  [[nodiscard]] tl::expected<int32_t, std::string> decode(size_t index);

 private:
  struct Entry {
    std::span<const uint8_t> bytes;
    tl::expected<ImageHeader, std::string> header = tl::unexpected<std::string>("");
    std::string
        refusal;  // why the scene is refused if a material uses the image; empty if it is valid
    bool tried = false;
    int32_t image = -1;
  };
  std::string name(size_t index) const;
  void read_header(size_t index);
  void limit_sides(const ImageLimits& limits);
  uint32_t reduction(const ImageHeader& header) const;

  const tinygltf::Model& model_;
  Scene& scene_;
  std::vector<Entry> entries_;
  uint32_t largest_side_ = kLargestImageSide;
};

}  // namespace alcove::sample
