#include "gpu_cost/modelled_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove::sample {
namespace {

using passes::cost::CompiledLoop;
using passes::cost::FrameState;
using passes::cost::PassWork;
using Failure = tl::unexpected<std::string>;

// The statistics that RADV reports for a shader.
struct Statistics {
  double vector_registers, scalar_registers, spills, scratch_bytes, code_bytes, shared_bytes;
  double subgroups_per_simd, latency, inverse_throughput;
};

tl::expected<Statistics, std::string> statistics_of(const CompiledShader& shader) {
  std::string missing;
  const auto get = [&](const char* name) {
    const auto found = shader.statistics.find(name);
    if (found == shader.statistics.end()) {
      missing = name;
      return 0.0;
    }
    return found->second;
  };
  const Statistics statistics{
      .vector_registers = get("VGPRs"),
      .scalar_registers = get("SGPRs"),
      .spills = get("Spilled VGPRs") + get("Spilled SGPRs"),
      .scratch_bytes = get("Scratch size"),
      .code_bytes = get("Code size"),
      .shared_bytes = get("LDS size"),
      .subgroups_per_simd = get("Subgroups per SIMD"),
      .latency = get("Latency"),
      .inverse_throughput = get("Inverse Throughput"),
  };
  if (!missing.empty()) {
    return Failure("The driver reports no statistic '" + missing +
                   "' for its pipelines; the model supports RADV of Mesa 22.3.");
  }
  return statistics;
}

// Returns the latency of one wave in cycles. The compiler's latency assumes that each loop runs 8
// times, so it is multiplied by the ratio of the work with the true counts to the work with these
// assumed ones.
double wave_latency(const Statistics& statistics, const WaveWork& work, double held,
                    std::uint32_t wave, bool loops) {
  if (!loops) {
    return statistics.latency;
  }
  // The compiler's statistic "Inverse throughput" is in cycles for 64 lanes. If a single wave is
  // limited by latency, the compiler reports the latency instead.
  const double throughput = statistics.inverse_throughput * wave / 64;
  const double usage =
      throughput * held > statistics.latency * 1.02 ? throughput : statistics.latency;
  return statistics.latency * work.busiest() / std::max(usage, 1.0);
}

struct Model {
  const GpuPart& part;
  const RecordingDevice& device;
  const CostInputs& inputs;

  double pixels() const { return static_cast<double>(inputs.width) * inputs.height; }
  tl::expected<ModelledPass, std::string> cost(const RecordedPass& pass, FrameState state) const;
  tl::expected<void, std::string> add_dispatch(const RecordedDispatch& dispatch, FrameState state,
                                               ModelledPass& cost) const;
};

tl::expected<void, std::string> Model::add_dispatch(const RecordedDispatch& dispatch,
                                                    FrameState state, ModelledPass& cost) const {
  const CompiledShader* shader = device.compiled(dispatch.pipeline);
  if (shader == nullptr) {
    return Failure("The pass '" + cost.pass + "' runs a pipeline that was not recorded.");
  }
  const auto statistics = statistics_of(*shader);
  const auto blocks = blocks_of(*shader);
  if (!statistics || !blocks) {
    return Failure(statistics ? blocks.error() : statistics.error());
  }
  const std::vector<Loop> loops = loops_of(*blocks);
  std::vector<CompiledLoop> summaries;
  for (const Loop& loop : loops) {
    summaries.push_back(loop.summary);
  }
  const PassWork work{cost.pass, inputs.settings, state, summaries};
  std::vector<double> iterations;
  for (const CompiledLoop& loop : summaries) {
    const auto count = passes::cost::iterations(work, loop);
    if (!count) {
      return Failure(count.error());
    }
    iterations.push_back(*count);
    cost.loops.push_back({loop, *count});
  }
  const double wave = shader->wave;
  cost.wave = wave_work(*blocks, loops, iterations, part.rdna, shader->wave);
  cost.waves = static_cast<double>(dispatch.groups) * std::ceil(shader->group / wave);
  cost.vector_registers = std::max(cost.vector_registers, statistics->vector_registers);
  cost.scalar_registers = std::max(cost.scalar_registers, statistics->scalar_registers);
  cost.spills += statistics->spills;
  cost.scratch_bytes += statistics->scratch_bytes;
  cost.code_bytes += statistics->code_bytes;
  cost.shared_bytes = std::max(cost.shared_bytes, statistics->shared_bytes);
  // RDNA counts in subgroups of 32 lanes.
  const double held = part.rdna ? std::floor(statistics->subgroups_per_simd * 32 / wave)
                                : statistics->subgroups_per_simd;
  cost.waves_per_simd = cost.waves_per_simd == 0 ? held : std::min(cost.waves_per_simd, held);
  const double lanes = cost.waves * wave;
  cost.instructions_per_pixel += cost.wave.instructions * lanes / pixels();
  cost.fetches_per_pixel += cost.wave.loads * lanes / pixels();
  cost.stores_per_pixel += cost.wave.stores * lanes / pixels();
  const double per_simd = cost.waves / part.simds / part.hertz * 1e3;
  cost.alu_ms += per_simd * cost.wave.busiest();
  cost.texture_ms += cost.waves / part.compute_units * cost.wave.texture_cycles / part.hertz * 1e3;
  // A compute unit's shared memory moves 32 words a cycle.
  cost.shared_ms +=
      cost.waves / part.compute_units * cost.wave.shared_words * wave / 32 / part.hertz * 1e3;
  cost.latency_ms += per_simd / std::max(held, 1.0) *
                     wave_latency(*statistics, cost.wave, held, shader->wave, !loops.empty());
  return {};
}

tl::expected<ModelledPass, std::string> Model::cost(const RecordedPass& pass,
                                                    FrameState state) const {
  ModelledPass cost;
  cost.pass = pass.name;
  for (const RecordedDispatch& dispatch : pass.dispatches) {
    if (auto added = add_dispatch(dispatch, state, cost); !added) {
      return Failure(std::move(added.error()));
    }
  }
  const PassWork work{cost.pass, inputs.settings, state, {}};
  for (const ImageTraffic& traffic : pass.traffic) {
    cost.bytes_per_pixel += traffic.bytes / pixels() *
                            passes::cost::traffic_share(work, traffic.image, traffic.direction);
  }
  cost.cache_lines_per_load = passes::cost::cache_lines_per_load(work);
  cost.bandwidth_ms = cost.bytes_per_pixel * pixels() / part.bytes_per_second * 1e3;
  return cost;
}

}  // namespace

double ModelledPass::milliseconds() const {
  return std::max({alu_ms, texture_ms, shared_ms, bandwidth_ms, latency_ms});
}

std::string_view ModelledPass::limit() const {
  const double longest = milliseconds();
  return longest == alu_ms         ? "ALU"
         : longest == texture_ms   ? "texture"
         : longest == shared_ms    ? "shared memory"
         : longest == bandwidth_ms ? "bandwidth"
                                   : "latency";
}

double ModelledFrame::milliseconds() const {
  double sum = 0;
  for (const ModelledPass& pass : passes) {
    sum += pass.milliseconds();
  }
  return sum;
}

tl::expected<std::vector<ModelledFrame>, std::string> modelled_frames(const GpuPart& part,
                                                                      const NullDevice& device,
                                                                      const CostInputs& inputs) {
  RecordingDevice recording(device);
  const auto frames = record_frames(recording, inputs);
  if (!frames) {
    return Failure(frames.error());
  }
  const Model model{part, recording, inputs};
  std::vector<ModelledFrame> costs;
  for (const RecordedFrame& frame : *frames) {
    ModelledFrame cost{frame.state, {}};
    for (const RecordedPass& pass : frame.passes) {
      auto modelled = model.cost(pass, frame.state);
      if (!modelled) {
        return Failure(std::move(modelled.error()));
      }
      cost.passes.push_back(std::move(*modelled));
    }
    costs.push_back(std::move(cost));
  }
  return costs;
}

}  // namespace alcove::sample
