// The memory traffic of a dispatch: the texels that its waves read and write, run through the
// caches of a GPU.
//
// Every wave of the frame is followed, with the addresses that accesses.h declares. The waves of a
// compute unit are in flight together, as many as their registers allow, and drift apart. Images
// are stored in tiles of one cache line. Stores go to L2. A last-level cache serves what L2 misses
// as far as it holds the images of the dispatch. Left out: compressed depth, conflicts between
// banks, and what other work leaves in the caches.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "gpu_cost/accesses.h"
#include "gpu_cost/gpu_part.h"

namespace alcove::sample {

struct CacheTraffic {
  double lines_per_load = 0;  // cache lines that a load of a wave touches
  double l2_bytes = 0;        // that L2 receives and sends
  double memory_bytes = 0;    // that memory, or the last-level cache, receives and sends
  double texture_ms = 0;      // of the busiest texture unit: four lanes or a line a cycle
  double l2_ms = 0;
  double memory_ms = 0;
  double milliseconds() const { return std::max({texture_ms, l2_ms, memory_ms}); }
};

// Assumptions about the parts that no published source settles. They decide most of the times.
struct CacheAssumptions {
  std::string_view name;                // of what differs from the first of kCacheAssumptions
  bool flat_tiles = false;              // lines of 8-byte texels are twice as wide, half as high
  std::uint32_t accesses_in_a_row = 1;  // that a wave executes before others have their turn
  double fetched_part = 1;              // of a line that a miss of a cache moves
  double l2_width = 1;                  // of the bytes per cycle that GpuPart states
  double waves = 1;                     // in flight, of those that the registers allow
  bool hashed_sets = true;              // false: address bits select the set of L2
};
// The assumptions of the model, and others that differ in one point each.
inline constexpr std::array<CacheAssumptions, 7> kCacheAssumptions{
    {{"the model"},
     {.name = "8-byte texels in flat tiles", .flat_tiles = true},
     {.name = "two accesses of a wave in a row", .accesses_in_a_row = 2},
     {.name = "fetches of half a line", .fetched_part = 0.5},
     {.name = "half the width of L2", .l2_width = 0.5},
     {.name = "half the waves in flight", .waves = 0.5},
     {.name = "sets of L2 by address bits", .hashed_sets = false}}};

// `waves_per_simd` is the number of waves in flight on a SIMD.
[[nodiscard]] CacheTraffic cache_traffic(
    const GpuPart& part, const DispatchAccesses& dispatch, double waves_per_simd,
    const CacheAssumptions& assumptions = kCacheAssumptions.front());

}  // namespace alcove::sample
