// The functions that work.cpp chooses from, one pair for each pass that has loops or partial
// traffic. `nullopt` is a loop that the function does not know.
#pragma once

#include <optional>
#include <vector>

#include "work.h"

namespace alcove::passes::cost {

[[nodiscard]] std::optional<double> gtao_iterations(const PassWork& work, const CompiledLoop& loop);
[[nodiscard]] double gtao_traffic(const PassWork& work, std::string_view image,
                                  Direction direction);

[[nodiscard]] std::optional<double> reconstruct_iterations(const PassWork& work,
                                                           const CompiledLoop& loop);
[[nodiscard]] std::vector<LoadPattern> reconstruct_loads(const PassWork& work);
[[nodiscard]] double reconstruct_traffic(const PassWork& work, std::string_view image,
                                         Direction direction);

}  // namespace alcove::passes::cost
