#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// A glTF file as tinygltf's model, with buffers and encoded images filled in.
struct GltfModel {
  // Only the properties that gltf_properties.h lists are filled in. A buffer without data, which
  // the specification allows, is empty. Image::image has the bytes of the image file; it is empty
  // for images in a buffer view, for those that no mesh of a node uses, and for those that cannot
  // be read. Image::uri fits into a sentence.
  tinygltf::Model model;
  std::vector<std::string> warnings;  // one sentence each: which images cannot be read
};

// Takes a binary file apart (gltf_container.h), checks the JSON (gltf_properties.h) and its node
// tree, lets tinygltf read what is left, and reads what its URIs name (gltf_files.h). The error is
// a sentence without its end, in which the file is "it".
[[nodiscard]] tl::expected<GltfModel, std::string> read_gltf_model(
    std::vector<uint8_t> file, const std::filesystem::path& folder);

}  // namespace alcove::sample
