// The functions that work.cpp calls for passes with loops. The result is `nullopt` if the loop is
// not known.
#pragma once

#include <optional>

#include "work.h"

namespace alcove::passes::cost {

[[nodiscard]] std::optional<double> gtao_iterations(const PassWork& work, const CompiledLoop& loop);
[[nodiscard]] std::optional<double> reconstruct_iterations(const PassWork& work,
                                                           const CompiledLoop& loop);

}  // namespace alcove::passes::cost
