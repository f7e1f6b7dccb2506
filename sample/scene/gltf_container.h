#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

// The parts of a glTF file: its JSON and, of a binary file (.glb) that has one, the binary chunk.
struct GltfParts {
  std::span<const uint8_t> json;
  std::span<const uint8_t> binary;
  bool has_binary = false;
};

// Takes a file of either kind apart (glTF 2.0 section 4.4 for the binary one, told by its magic
// number). An error, the end of a sentence: a header or chunk that is cut short, of a wrong length,
// unaligned, repeated or out of order. Chunks of unknown types are skipped.
[[nodiscard]] tl::expected<GltfParts, std::string> split_gltf(std::span<const uint8_t> file);

}  // namespace alcove::sample
