#pragma once

#include <nlohmann/json.hpp>
#include <random>

namespace alcove::sample {

// Changes a JSON tree in one place, so that it stays JSON and mostly stays glTF: a value is
// replaced by a close one, an extreme one or one of another type; a member or element is removed,
// repeated, or replaced by a copy from elsewhere in the tree.
void mutate_json(nlohmann::json& root, std::minstd_rand& random);

}  // namespace alcove::sample
