#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "support/result.h"

namespace alcove::sample {

// Functions that read a glTF model's binary data (glTF 2.0 section 3.6). The model is not trusted:
// every index, offset, stride and count is checked against the size of the data. Error texts are
// the end of a sentence that starts with the file's name.

// Returns the bytes of a buffer view, which is given or is one of the model.
[[nodiscard]] Result<std::span<const uint8_t>> view_bytes(const tinygltf::Model& model,
                                                          const tinygltf::BufferView& view);
[[nodiscard]] Result<std::span<const uint8_t>> view_bytes(const tinygltf::Model& model,
                                                          int64_t view);

// Returns the accessor of an attribute of a primitive or of a morph target, or -1 without it.
[[nodiscard]] int attribute(const std::map<std::string, int>& attributes, const std::string& name);

// Reads elements of an accessor as floats: all if `only` is null, otherwise those of its ascending
// indices. Each element has `components` components: 1 to 4, or 16 for a matrix. Normalised
// integers are mapped to [0,1] or [-1,1]; other integers keep their value. Sparse values replace
// those of the buffer view. An accessor with another number of components, or without one of the
// elements, is an error, and so are more than `most` elements without `only`.
[[nodiscard]] Result<std::vector<float>> read_floats(const tinygltf::Model& model, int64_t accessor,
                                                     int components, uint64_t most,
                                                     const std::vector<uint32_t>* only = nullptr);

// Reads a scalar accessor of unsigned integers. A value that is not below `bound`, or more than
// `most` values, is an error.
[[nodiscard]] Result<std::vector<uint32_t>> read_indices(const tinygltf::Model& model,
                                                         int64_t accessor, uint64_t bound,
                                                         uint64_t most);

}  // namespace alcove::sample
