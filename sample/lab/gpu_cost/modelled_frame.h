// The modelled GPU time of the occlusion passes.
//
// A pass takes the longest of these times, plus that of its dispatches; passes add up:
//   ALU      cycles of the busiest execution unit of a SIMD, for as many whole waves as it gets
//   texture  cycles of the busiest texture unit: four lanes or one cache line a cycle
//   shared   words that lanes move to and from shared memory, at 32 a cycle of a compute unit
//   L2       bytes that L2 receives and sends, after the caches before it
//   memory   bytes that memory, or the last-level cache, receives and sends, after L2
//   latency  the compiler's latency of one wave, over the waves that a SIMD holds
// A dispatch costs GpuPart::dispatch_seconds, because each waits for the one before. The figures
// are the same on every run and on every machine. cache_traffic.h says what is left out.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "gpu_cost/cache_traffic.h"
#include "gpu_cost/frame_work.h"
#include "gpu_cost/gpu_part.h"
#include "gpu_cost/wave.h"
#include "support/result.h"

namespace alcove::sample {

// The statistics that RADV reports for a shader.
struct ShaderStatistics {
  double vector_registers = 0;  // of an invocation
  double scalar_registers = 0;  // of a wave
  double spills = 0;            // registers in memory
  double scratch_bytes = 0;
  double code_bytes = 0;
  double shared_bytes = 0;  // of a workgroup
  double subgroups_per_simd = 0;
  double latency = 0;             // of a wave, cycles, with loops that run 8 times
  double inverse_throughput = 0;  // cycles
};

// The times of which a pass takes the longest, in this order.
inline constexpr std::array<std::string_view, 6> kLimitNames{"ALU", "texture", "shared memory",
                                                             "L2",  "memory",  "latency"};

struct ModelledPass {
  std::string pass;
  ShaderStatistics statistics;
  double waves_per_simd = 0;  // of at most 10 on GCN and 16 on RDNA2
  WaveWork wave;              // of one wave
  double waves = 0;
  // For each pixel of the full image.
  double instructions_per_pixel = 0;
  double fetches_per_pixel = 0;
  double stores_per_pixel = 0;
  double l2_bytes_per_pixel = 0;
  double bytes_per_pixel = 0;  // beyond L2
  double cache_lines_per_load = 0;
  double declared_loads = 0;  // of a wave by accesses.h, beside wave.loads of the compiled shader
  std::array<double, kLimitNames.size()> limits_ms{};
  double dispatch_ms = 0;  // added to the longest of the others

  double milliseconds() const { return *std::ranges::max_element(limits_ms) + dispatch_ms; }
  std::string_view limit() const;  // the name of the longest of the six times
};

struct ModelledFrame {
  FrameState state = FrameState::first;
  std::vector<ModelledPass> passes;
  double milliseconds() const;
};

// Returns the modelled time of a frame of one state, or of each FrameState, on one GPU. Without
// `assumptions` the caches are not simulated, and the times leave them out. Errors: those of
// describe_frames() and compile_dispatch(), the driver's text cannot be parsed, the iterations of a
// loop are not declared.
[[nodiscard]] Result<ModelledFrame> modelled_frame(
    const GpuPart& part, const NullDevice& device, const CostInputs& inputs, FrameState state,
    const CacheAssumptions* assumptions = &kCacheAssumptions.front());
[[nodiscard]] Result<std::vector<ModelledFrame>> modelled_frames(
    const GpuPart& part, const NullDevice& device, const CostInputs& inputs,
    const CacheAssumptions* assumptions = &kCacheAssumptions.front());

// The registers of a pass and the waves that they allow, for each ProjectionKind: the most
// registers and the fewest waves of all frames.
struct Occupancy {
  std::string pass;
  std::array<double, kProjectionNames.size()> vector_registers{};
  std::array<double, kProjectionNames.size()> waves_per_simd{};
  std::array<double, kProjectionNames.size()> spills{};
};

// Returns the occupancy of each pass that a frame of any state runs.
[[nodiscard]] Result<std::vector<Occupancy>> occupancies(const GpuPart& part,
                                                         const NullDevice& device,
                                                         CostInputs inputs);

}  // namespace alcove::sample
