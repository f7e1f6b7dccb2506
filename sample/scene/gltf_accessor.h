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

// The bytes of a buffer view.
[[nodiscard]] tl::expected<std::span<const uint8_t>, std::string> view_bytes(
    const tinygltf::Model& model, int64_t view);

// All elements as floats, `components` of each: 1 to 4, or 16 for matrices of floats. Normalised
// integers are mapped to 0..1 or -1..1, other integers keep their value; sparse values replace
// those of the buffer view. An accessor of another number of components, or of more than `most`
// elements, is an error.
[[nodiscard]] tl::expected<std::vector<float>, std::string> read_floats(
    const tinygltf::Model& model, int64_t accessor, int components, uint64_t most);

// A scalar accessor of at most `most` unsigned integers. A value of `bound` or more is an error.
[[nodiscard]] tl::expected<std::vector<uint32_t>, std::string> read_indices(
    const tinygltf::Model& model, int64_t accessor, uint64_t bound, uint64_t most);

}  // namespace alcove::sample
