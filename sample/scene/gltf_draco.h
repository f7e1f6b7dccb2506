#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "support/result.h"

namespace alcove::sample {

// Decompresses the primitives that have the extension KHR_draco_mesh_compression, and gives them
// new accessors. The extension's own properties are known to be of the right type
// (gltf_properties.h). Together they may have at most 2^24 triangles and 1 GiB, and one at most 64
// triangles for each byte. A primitive that cannot be decompressed keeps its own accessors, with a
// note, if they have data. The error text is the end of a sentence whose beginning the caller adds.
[[nodiscard]] Result<void> decompress_primitives(tinygltf::Model& model,
                                                 std::vector<std::string>& notes);

}  // namespace alcove::sample
