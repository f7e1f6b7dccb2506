#include "gpu_cost/modelled_frame.h"

#include <algorithm>
#include <cmath>

#include "gpu_cost/cache_traffic.h"

namespace alcove::sample {
namespace {

using passes::cost::CompiledBranch;
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

// The waves that a SIMD holds. RDNA counts in subgroups of 32 lanes.
double waves_held(const GpuPart& part, const Statistics& statistics, double wave) {
  return part.rdna ? std::floor(statistics.subgroups_per_simd * 32 / wave)
                   : statistics.subgroups_per_simd;
}

struct Model {
  const GpuPart& part;
  const RecordingDevice& device;
  const CostInputs& inputs;

  double pixels() const { return static_cast<double>(inputs.width) * inputs.height; }
  double milliseconds(double cycles) const { return cycles / part.hertz * 1e3; }
  tl::expected<ModelledPass, std::string> cost(const RecordedPass& pass, FrameState state) const;
  tl::expected<void, std::string> add_dispatch(const RecordedDispatch& dispatch,
                                               std::span<const passes::cost::PassImage> images,
                                               FrameState state, ModelledPass& cost) const;
};

tl::expected<void, std::string> Model::add_dispatch(const RecordedDispatch& dispatch,
                                                    std::span<const passes::cost::PassImage> images,
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
  std::vector<Branch> branches = branches_of(*blocks);
  for (Branch& branch : branches) {
    branch.summary.loops =
        static_cast<std::uint32_t>(std::ranges::count_if(loops, [&](const Loop& loop) {
          return branch.first <= loop.first && loop.last <= branch.last;
        }));
    branch.share = passes::cost::branch_share(work, branch.summary);
    if (branch.share < 1.0) {
      cost.branches.push_back({branch.summary, branch.share});
    }
  }
  const double wave = shader->wave;
  cost.wave = wave_work(*blocks, loops, iterations, branches, part.rdna, shader->wave);
  const double waves = static_cast<double>(dispatch.groups_x) * dispatch.groups_y *
                       dispatch.groups_z * std::ceil(shader->group / wave);
  cost.waves += waves;
  cost.vector_registers = std::max(cost.vector_registers, statistics->vector_registers);
  cost.scalar_registers = std::max(cost.scalar_registers, statistics->scalar_registers);
  cost.spills += statistics->spills;
  cost.scratch_bytes += statistics->scratch_bytes;
  cost.code_bytes += statistics->code_bytes;
  cost.shared_bytes = std::max(cost.shared_bytes, statistics->shared_bytes);
  const double held = waves_held(part, *statistics, wave);
  cost.waves_per_simd = cost.waves_per_simd == 0 ? held : std::min(cost.waves_per_simd, held);
  const double lanes = waves * wave;
  cost.instructions_per_pixel += cost.wave.instructions * lanes / pixels();
  cost.fetches_per_pixel += cost.wave.loads * lanes / pixels();
  cost.stores_per_pixel += cost.wave.stores * lanes / pixels();
  // A SIMD executes whole waves, so that some SIMDs may execute one more than others.
  cost.alu_ms += milliseconds(std::ceil(waves / part.simds) * cost.wave.busiest());
  cost.latency_ms +=
      milliseconds(std::ceil(waves / part.simds / std::max(held, 1.0)) *
                   wave_latency(*statistics, cost.wave, held, shader->wave, !loops.empty()));
  const double per_unit = std::ceil(waves / part.compute_units);
  // A compute unit's shared memory moves 32 words a cycle.
  cost.shared_ms += milliseconds(per_unit * cost.wave.shared_words * wave / 32);
  const CacheTraffic traffic = cache_traffic(
      part,
      passes::cost::accesses_of(work, images, inputs.height,
                                {dispatch.groups_x, dispatch.groups_y, dispatch.groups_z}),
      held);
  cost.texture_ms +=
      milliseconds(std::max(per_unit * cost.wave.texture_cycles, traffic.texture_cycles));
  cost.l2_bytes_per_pixel += traffic.l2_bytes / pixels();
  cost.bytes_per_pixel += traffic.memory_bytes / pixels();
  cost.l2_ms += l2_ms(part, traffic);
  cost.memory_ms += memory_ms(part, traffic);
  cost.cache_lines_per_load = std::max(cost.cache_lines_per_load, traffic.lines_per_load);
  cost.dispatch_ms += 1e3 * part.dispatch_seconds;
  return {};
}

tl::expected<ModelledPass, std::string> Model::cost(const RecordedPass& pass,
                                                    FrameState state) const {
  ModelledPass cost;
  cost.pass = pass.name;
  for (const RecordedDispatch& dispatch : pass.dispatches) {
    if (auto added = add_dispatch(dispatch, pass.images, state, cost); !added) {
      return Failure(std::move(added.error()));
    }
  }
  return cost;
}

// Returns the modelled cost of a pass of an earlier frame that equals `pass`, or null.
const ModelledPass* find_same(const std::vector<RecordedFrame>& frames,
                              const std::vector<ModelledFrame>& costs, const RecordedPass& pass) {
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const auto same = std::ranges::find(frames[i].passes, pass);
    if (same != frames[i].passes.end()) {
      return &costs[i].passes[static_cast<std::size_t>(same - frames[i].passes.begin())];
    }
  }
  return nullptr;
}

}  // namespace

double ModelledPass::busy_ms() const {
  return std::max({alu_ms, texture_ms, shared_ms, l2_ms, memory_ms, latency_ms});
}

std::string_view ModelledPass::limit() const {
  const double longest = busy_ms();
  return longest <= alu_ms       ? "ALU"
         : longest <= texture_ms ? "texture"
         : longest <= shared_ms  ? "shared memory"
         : longest <= l2_ms      ? "L2"
         : longest <= memory_ms  ? "memory"
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
      // Frames that run the same pipelines on the same images do the same work.
      if (const ModelledPass* same = find_same(*frames, costs, pass)) {
        cost.passes.push_back(*same);
        continue;
      }
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

tl::expected<std::vector<Occupancy>, std::string> occupancies(const GpuPart& part,
                                                              const NullDevice& device,
                                                              CostInputs inputs) {
  std::vector<Occupancy> found;
  for (std::size_t kind = 0; kind < kProjectionNames.size(); ++kind) {
    inputs.projection = static_cast<ProjectionKind>(kind);
    RecordingDevice recording(device);
    const auto frames = record_frames(recording, inputs);
    if (!frames) {
      return Failure(frames.error());
    }
    for (const RecordedFrame& frame : *frames) {
      for (const RecordedPass& pass : frame.passes) {
        auto own = std::ranges::find(found, pass.name, &Occupancy::pass);
        if (own == found.end()) {
          own = found.insert(own, Occupancy{pass.name});
        }
        for (const RecordedDispatch& dispatch : pass.dispatches) {
          const CompiledShader& shader = *recording.compiled(dispatch.pipeline);
          const auto statistics = statistics_of(shader);
          if (!statistics) {
            return Failure(statistics.error());
          }
          const double held = waves_held(part, *statistics, shader.wave);
          double& waves = own->waves_per_simd[kind];
          waves = waves == 0 ? held : std::min(waves, held);
          double& registers = own->vector_registers[kind];
          registers = std::max(registers, statistics->vector_registers);
          own->spills[kind] = std::max(own->spills[kind], statistics->spills);
        }
      }
    }
  }
  return found;
}

}  // namespace alcove::sample
