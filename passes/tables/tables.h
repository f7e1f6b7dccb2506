// The tables that the passes look up, by integrals: run in the build, and by the tests.
#pragma once

#include <cstdint>
#include <vector>

namespace alcove::passes {

// maths/split_sum.h's pairs over (view, roughness), the view fastest: two 16-bit parts of 1 a word,
// the factor of f0 in the lower half.
[[nodiscard]] std::vector<std::uint32_t> reflectance_table();

}  // namespace alcove::passes
