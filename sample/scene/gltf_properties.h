#pragma once

#include <nlohmann/json.hpp>

#include "support/result.h"

namespace alcove::sample {

// Checks every property of a glTF file that the loader reads against one schema: its type, its
// range and whether it may be missing (glTF 2.0 section 5 and the schemas of the extensions). This
// is needed because tinygltf silently drops values of a wrong type and wraps integers that are too
// large.
//
// The result has the properties of the schema and no others, so that a property that is not checked
// does not reach the loader. Whole numbers that are written with a fraction (4.0) become integers.
// `animations` keeps only its number of elements. The error names the property by its path, such as
// nodes[3].scale[1], with its value and the allowed values.
[[nodiscard]] Result<nlohmann::json> checked_properties(nlohmann::json root);

}  // namespace alcove::sample
