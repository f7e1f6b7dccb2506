#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/gltf_files.h"
#include "support/result.h"

namespace alcove::sample {

// A glTF file as tinygltf's model, with its buffers.
struct GltfModel {
  // The model. Only the properties that gltf_properties.h lists are filled in. A buffer without
  // data, which the specification allows, is empty. Compressed buffer views and primitives are
  // decompressed (gltf_meshopt.h, gltf_draco.h). Images have their `uri` or `bufferView`, and no
  // pixels.
  tinygltf::Model model;
  GltfFiles files;                    // reads the files that URIs of images name
  std::vector<std::string> warnings;  // one sentence for each extension that is left out
};

// Splits a binary file (gltf_container.h), checks the JSON (gltf_properties.h) and its node tree,
// lets tinygltf convert it, and reads the buffers that URIs name (gltf_files.h). A file is refused
// if it requires an extension that is known to change geometry and is not read. The error is the
// beginning of a sentence in which the file is called "it".
[[nodiscard]] Result<GltfModel> read_gltf_model(std::vector<uint8_t> file,
                                                const std::filesystem::path& folder);

}  // namespace alcove::sample
