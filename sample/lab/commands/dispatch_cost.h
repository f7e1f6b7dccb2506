#pragma once

#include <string>

#include "gpu/gpu.h"
#include "support/result.h"

namespace alcove::sample {

// The GPU time of dispatches of one workgroup that does nothing, in microseconds; medians.
struct DispatchCost {
  double alone_us = 0;           // of one in a row of dispatches without barriers
  double behind_barrier_us = 0;  // of one that waits for the memory writes of the one before
};

[[nodiscard]] Result<DispatchCost> measure_dispatch_cost(Gpu& gpu);

}  // namespace alcove::sample
