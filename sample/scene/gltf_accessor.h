#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// Checked reading of a glTF model's binary data (glTF 2.0 section 3.6). The model is not trusted:
// every index, offset, stride and count is checked against the bytes that are there. Errors are the
// end of a sentence that starts with the file's name.

// The bytes of a buffer view, or why there are none.
[[nodiscard]] tl::expected<std::span<const uint8_t>, std::string> view_bytes(
    const tinygltf::Model& model, int64_t view);

// All elements as floats, `components` (1..4, or 16 for matrices of floats) each, in order;
// normalised integers are mapped to 0..1 or -1..1, others taken as they are; sparse values are put
// in. An accessor with more components than asked for is an error, so is one with more than `most`
// elements.
[[nodiscard]] tl::expected<std::vector<float>, std::string> read_floats(
    const tinygltf::Model& model, int64_t accessor, int components, uint64_t most);

// A scalar accessor of unsigned integers, each checked to be below `bound`.
[[nodiscard]] tl::expected<std::vector<uint32_t>, std::string> read_indices(
    const tinygltf::Model& model, int64_t accessor, uint64_t bound, uint64_t most);

}  // namespace alcove::sample
