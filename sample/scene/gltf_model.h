#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// A glTF file as tinygltf's model, with its buffers and its images, which are still encoded.
struct GltfModel {
  // The model. Only the properties that gltf_properties.h lists are filled in. A buffer without
  // data, which the specification allows, is empty. Image::image has the bytes of the image file;
  // it is empty for images in a buffer view, for images that no mesh of a node uses, and for images
  // that cannot be read. Image::uri is printable.
  tinygltf::Model model;
  std::vector<std::string> warnings;  // one sentence for each image that cannot be read
};

// Splits a binary file (gltf_container.h), checks the JSON (gltf_properties.h) and its node tree,
// lets tinygltf read the checked JSON, and reads the files that URIs name (gltf_files.h). The error
// is the beginning of a sentence in which the file is called "it".
[[nodiscard]] tl::expected<GltfModel, std::string> read_gltf_model(
    std::vector<uint8_t> file, const std::filesystem::path& folder);

}  // namespace alcove::sample
