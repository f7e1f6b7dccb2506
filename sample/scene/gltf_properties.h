#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

// Checks every property of a glTF file that the loader reads against one table: its type, its range
// and whether it may be missing (glTF 2.0 section 5 and the schemas of the extensions). tinygltf
// drops values of a wrong type and wraps integers that are too large without a message.
//
// The result holds the properties of the table and no others, so a property that is not checked
// does not reach the loader. Whole numbers that are written with a fraction (4.0) become integers.
// `animations` keeps its length only. The error names the property by its path, such as
// nodes[3].scale[1], with its value and what it must be.
[[nodiscard]] tl::expected<nlohmann::json, std::string> checked_properties(nlohmann::json root);

}  // namespace alcove::sample
