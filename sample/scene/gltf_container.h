#pragma once

#include <cstdint>
#include <span>

#include "support/result.h"

namespace alcove::sample {

// The parts of a glTF file: its JSON, and the binary chunk of a binary file (.glb) if there is one.
struct GltfParts {
  std::span<const uint8_t> json;
  std::span<const uint8_t> binary;
  bool has_binary = false;
};

// Splits a file into its parts. The magic number tells whether it is binary (glTF 2.0 section 4.4).
// Chunks of unknown types are skipped. A header or chunk that is cut short, has a wrong length, or
// is unaligned, repeated or out of order is an error. The error text is the end of a sentence whose
// beginning the caller adds.
[[nodiscard]] Result<GltfParts> split_gltf(std::span<const uint8_t> file);

}  // namespace alcove::sample
