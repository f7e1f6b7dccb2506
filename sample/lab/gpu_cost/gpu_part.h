// The GPUs of the cost model.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace alcove::sample {

struct GpuPart {
  std::string_view family;  // as RADV_FORCE_FAMILY names it
  std::string_view name;    // for --gpu
  std::string_view title;
  bool rdna;  // true: RDNA2; false: GCN
  double compute_units;
  double simds;
  double hertz;
  double bytes_per_second;    // of memory
  double l2_bytes_per_cycle;  // between L2 and the compute units
  double line_bytes;          // of a cache line
  double l1_bytes;            // of a compute unit
  double array_l1_bytes;      // that a shader array shares between L1 and L2; 0: there is none
  std::size_t array_units;    // compute units of a shader array
  double l2_bytes;
  // The time of a dispatch that waits for the one before: the barrier drains the waves and
  // invalidates caches, then the first waves start. `alcove measure` measures it on a GPU.
  double dispatch_seconds;
};

inline constexpr std::array<GpuPart, 2> kGpuParts{
    {{"bonaire", "ps4", "PS4-like GCN, 18 CUs, 800 MHz, 176 GB/s", false, 18, 72, 800e6, 176e9, 512,
      64, 16384, 0, 1, 512 << 10, 5e-6},
     {"navi21", "rdna2", "RDNA2, 72 CUs, 2250 MHz, 512 GB/s", true, 72, 144, 2250e6, 512e9, 2048,
      128, 16384, 128 << 10, 9, 4 << 20, 2e-6}}};

}  // namespace alcove::sample
