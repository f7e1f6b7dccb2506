#pragma once

#include <tiny_gltf.h>

#include <string>

#include "support/result.h"

namespace alcove::sample {

// Decompresses the buffer views that have the extension EXT_meshopt_compression, or
// KHR_meshopt_compression, and replaces each by a view of a buffer of its own. The extension's own
// properties are known to be of the right type (gltf_properties.h). All views together may have at
// most 1 GiB. A view that cannot be decompressed keeps its fallback, with a note, if the file has
// one. The error text is the end of a sentence whose beginning the caller adds.
[[nodiscard]] Result<void> decompress_views(tinygltf::Model& model,
                                            std::vector<std::string>& notes);

}  // namespace alcove::sample
