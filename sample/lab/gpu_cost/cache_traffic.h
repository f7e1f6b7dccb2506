// The memory traffic of a dispatch: the texels that its waves read and write, run through the
// caches of a GPU.
//
// Every wave of the frame is followed, with the addresses that accesses.h declares. The waves of a
// compute unit are in flight together, as many as their registers allow, and drift apart. Images
// are stored in square tiles of one cache line. Stores go to L2. Left out: the last-level cache of
// RDNA2 parts, compressed depth, and conflicts between banks.
#pragma once

#include "gpu_cost/accesses.h"
#include "gpu_cost/gpu_part.h"

namespace alcove::sample {

struct CacheTraffic {
  double lines_per_load = 0;  // cache lines that a load of a wave touches
  double texture_cycles = 0;  // of the busiest texture unit: four lanes, a line or a miss a cycle
  double l2_bytes = 0;        // that L2 receives and sends
  double memory_bytes = 0;    // that memory receives and sends
};

// `waves_per_simd` is the number of waves in flight on a SIMD.
[[nodiscard]] CacheTraffic cache_traffic(const GpuPart& part, const DispatchAccesses& dispatch,
                                         double waves_per_simd);

// The time that L2, and memory, take for the traffic, in milliseconds.
[[nodiscard]] double l2_ms(const GpuPart& part, const CacheTraffic& traffic);
[[nodiscard]] double memory_ms(const GpuPart& part, const CacheTraffic& traffic);
// The longest of the times of texture units, L2 and memory.
[[nodiscard]] double cache_ms(const GpuPart& part, const CacheTraffic& traffic);

}  // namespace alcove::sample
