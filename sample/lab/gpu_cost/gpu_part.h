// The GPUs of the cost model.
//
// Sources. Compute units, clocks and memory: Sony, "PlayStation 4" (press release of February 2013)
// and Cerny, "The Road to PS5" (2020); AMD, "Radeon RX 6800 XT" (product page: boost clock; 128 MiB
// of Infinity Cache at 16 x 64 bytes a cycle of 1.94 GHz). SIMDs, line sizes and sizes of L1:
// AMD, "Graphics Cores Next Architecture" (2012) and "RDNA Architecture" (2019). Sizes of caches of
// the families: kfd_crat.c of the Linux kernel; those of the PS5, which it does not list, are those
// of RDNA2 with 256 bits of memory. Width of L2: 64 bytes a cycle and slice on GCN (the same
// paper), of which the PS4 has 8. For RDNA2 128 bytes and 16 slices are assumed: with 64, the
// search of Bevy without depth levels would take 1.8 times as long as it does (gpu_cost_test).
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace alcove::sample {

struct GpuPart {
  std::string_view family;  // whose code is compiled, as RADV_FORCE_FAMILY names it
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
  double last_level_bytes;  // of the cache behind L2; 0: there is none
  double last_level_bytes_per_second;
  // The time of a dispatch that waits for the one before: the barrier drains the waves and
  // invalidates caches, then the first waves start. An assumption, which `alcove measure` measures.
  double dispatch_seconds;
};

inline constexpr std::array<GpuPart, 3> kGpuParts{
    {{"bonaire", "ps4", "PlayStation 4: 18 CUs of GCN, 800 MHz, 176 GB/s", false, 18, 72, 800e6,
      176e9, 512, 64, 16384, 0, 1, 512 << 10, 0, 0, 5e-6},
     {"navi21", "ps5", "PlayStation 5: 36 CUs of RDNA2, 2230 MHz, 448 GB/s", true, 36, 72, 2230e6,
      448e9, 2048, 128, 16384, 128 << 10, 9, 4 << 20, 0, 0, 2e-6},
     {"navi21", "rx6800xt", "RX 6800 XT: 72 CUs of RDNA2, 2250 MHz, 512 GB/s, 128 MiB behind L2",
      true, 72, 144, 2250e6, 512e9, 2048, 128, 16384, 128 << 10, 9, 4 << 20, 128 << 20, 1.94e12,
      2e-6}}};

}  // namespace alcove::sample
