// Declares the functions that work.cpp calls for passes with loops or with partial traffic, a pair
// for each of these passes. If the result of one is `nullopt`, it does not know the loop.
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
