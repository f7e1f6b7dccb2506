#pragma once

#include <cstdint>
#include <functional>

#include "support/progress.h"

namespace alcove::sample {

// Runs `row(y)` for every y below `rows` on all processors, in any order. Only the calling thread
// calls `progress`, with the completed fraction. `row` must not throw.
void parallel_rows(uint32_t rows, const std::function<void(uint32_t)>& row,
                   const Progress& progress = {});

}  // namespace alcove::sample
