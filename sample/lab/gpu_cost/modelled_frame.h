// The modelled GPU time of the occlusion passes.
//
// A pass takes the longest of five times, and passes add up:
//   ALU        cycles of the busiest execution unit of a SIMD, over all SIMDs
//   texture    cycles of the texture units, at four lanes a cycle
//   shared     words that lanes move to and from shared memory, at 32 a cycle of a compute unit
//   bandwidth  every image read or written once, over the memory's bandwidth
//   latency    the compiler's latency of one wave, over the waves that a SIMD holds
// This is a lower bound: it ignores cache misses beyond one transfer of each image and the fixed
// cost of a dispatch. The figures are the same on every run and on every machine.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu_cost/gpu_part.h"
#include "gpu_cost/recorded_frame.h"
#include "gpu_cost/wave.h"

namespace alcove::sample {

struct CountedLoop {
  passes::cost::CompiledLoop loop;
  double iterations = 0;
};

struct ModelledPass {
  std::string pass;
  double vector_registers = 0;  // of an invocation
  double scalar_registers = 0;  // of a wave
  double waves_per_simd = 0;    // of at most 10 on GCN and 16 on RDNA2
  double spills = 0;            // registers in memory
  double scratch_bytes = 0;
  double code_bytes = 0;
  double shared_bytes = 0;  // of a workgroup
  WaveWork wave;            // of one wave
  std::vector<CountedLoop> loops;
  double waves = 0;
  // For each pixel of the full image.
  double instructions_per_pixel = 0;
  double fetches_per_pixel = 0;
  double stores_per_pixel = 0;
  double bytes_per_pixel = 0;
  double cache_lines_per_load = 0;  // passes::cost::cache_lines_per_load(); 0: not declared
  double alu_ms = 0;
  double texture_ms = 0;
  double shared_ms = 0;
  double bandwidth_ms = 0;
  double latency_ms = 0;

  double milliseconds() const;
  std::string_view limit() const;  // the name of the longest of the five times
};

struct ModelledFrame {
  passes::cost::FrameState state = passes::cost::FrameState::first;
  std::vector<ModelledPass> passes;
  double milliseconds() const;
};

// Returns the modelled time of one frame of each FrameState on one GPU. Errors: those of
// record_frames(), the driver's text cannot be parsed, or the iterations of a loop are not
// declared.
[[nodiscard]] tl::expected<std::vector<ModelledFrame>, std::string> modelled_frames(
    const GpuPart& part, const NullDevice& device, const CostInputs& inputs);

}  // namespace alcove::sample
