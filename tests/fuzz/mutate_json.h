#pragma once

#include <nlohmann/json.hpp>
#include <random>

namespace alcove::sample {

// Changes one place of a JSON tree, so that it stays JSON and mostly stays glTF: a value gets a
// neighbour, an extreme or another type; a member or element is removed, repeated, or replaced by a
// copy from elsewhere in the tree.
void mutate_json(nlohmann::json& root, std::minstd_rand& random);

}  // namespace alcove::sample
