#include "gpu_cost/modelled_frame.h"

#include <fmt/format.h>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

Result<ShaderStatistics> read_statistics(const CompiledShader& shader) {
  std::string missing;
  const auto get = [&](const char* name) {
    const auto found = shader.statistics.find(name);
    if (found == shader.statistics.end()) {
      missing = name;
      return 0.0;
    }
    return found->second;
  };
  const ShaderStatistics statistics{
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
double wave_latency(const ShaderStatistics& statistics, const WaveWork& work, double held,
                    std::uint32_t wave, bool loops) {
  if (!loops) return statistics.latency;
  // The compiler's statistic "Inverse throughput" is in cycles for 64 lanes. If a single wave is
  // limited by latency, the compiler reports the latency instead.
  const double throughput = statistics.inverse_throughput * wave / 64;
  const double usage =
      throughput * held > statistics.latency * 1.02 ? throughput : statistics.latency;
  return statistics.latency * work.busiest() / std::max(usage, 1.0);
}

// The waves that a SIMD holds. RDNA counts in subgroups of 32 lanes.
double waves_held(const GpuPart& part, const ShaderStatistics& statistics, double wave) {
  return part.rdna ? std::floor(statistics.subgroups_per_simd * 32 / wave)
                   : statistics.subgroups_per_simd;
}

// Fills in what the caches contribute.
void add_caches(const GpuPart& part, const PassWork& work, const CacheAssumptions& assumptions,
                double pixels, ModelledPass& pass) {
  const DispatchAccesses dispatch = accesses_of(work);
  for (const ImageAccess& access : dispatch.accesses)
    pass.declared_loads += access.image.direction == Direction::read ? access.share : 0.0;
  const CacheTraffic traffic = cache_traffic(part, dispatch, pass.waves_per_simd, assumptions);
  pass.l2_bytes_per_pixel = traffic.l2_bytes / pixels;
  pass.bytes_per_pixel = traffic.memory_bytes / pixels;
  pass.cache_lines_per_load = traffic.lines_per_load;
  auto& [alu, texture, shared, l2, memory, latency] = pass.limits_ms;
  texture = std::max(texture, traffic.texture_ms);
  l2 = traffic.l2_ms;
  memory = traffic.memory_ms;
}

Result<ModelledPass> model(const GpuPart& part, const NullDevice& device, const CostInputs& inputs,
                           const AlcoveWork& frame, const AlcoveWorkDispatch& dispatch,
                           FrameState state, const CacheAssumptions* assumptions) {
  ALCOVE_TRY(const Pass pass, pass_of(dispatch.label));
  ALCOVE_TRY(const auto compiled, compile_dispatch(device, dispatch));
  const CompiledShader& shader = *compiled;
  ALCOVE_TRY(const auto statistics, read_statistics(shader));
  ALCOVE_TRY(const auto blocks, parse_blocks(shader));
  const auto images = dispatch_images(frame, dispatch);
  const auto& groups = dispatch.groups;
  const PassWork work{
      pass, inputs.settings, state, images, {groups[0], groups[1], groups[2]}, inputs.height};
  std::vector<Loop> loops = find_loops(blocks);
  std::vector<CompiledLoop> summaries;
  summaries.reserve(loops.size());
  for (const Loop& loop : loops) summaries.push_back(loop.summary);
  ALCOVE_TRY(const auto iterations, loop_iterations(work, summaries));
  for (std::size_t i = 0; i < iterations.size(); ++i) loops[i].iterations = iterations[i];
  std::vector<Branch> branches = find_branches(blocks);
  for (Branch& branch : branches) {
    branch.summary.loops =
        static_cast<std::uint32_t>(std::ranges::count_if(loops, [&](const Loop& loop) {
          return branch.first <= loop.first && loop.last <= branch.last;
        }));
    branch.share = branch_share(work, branch.summary);
  }
  const double wave = shader.wave;
  constexpr double kGroup = 64;  // invocations, as alcove_work.h says
  const double pixels = static_cast<double>(inputs.width) * inputs.height;
  const auto milliseconds = [&](double cycles) { return cycles / part.hertz * 1e3; };
  ModelledPass cost;
  cost.pass = dispatch.label;
  cost.statistics = statistics;
  cost.wave = wave_work(blocks, loops, branches, part.rdna, shader.wave);
  cost.waves = static_cast<double>(groups[0]) * groups[1] * groups[2] * std::ceil(kGroup / wave);
  cost.waves_per_simd = waves_held(part, statistics, wave);
  const double lanes = cost.waves * wave;
  cost.instructions_per_pixel = cost.wave.instructions * lanes / pixels;
  cost.fetches_per_pixel = cost.wave.loads * lanes / pixels;
  cost.stores_per_pixel = cost.wave.stores * lanes / pixels;
  const double per_unit = std::ceil(cost.waves / part.compute_units);
  const double per_simd = cost.waves / part.simds;
  cost.limits_ms = {
      // A SIMD executes whole waves, so that some SIMDs may execute one more than others.
      milliseconds(std::ceil(per_simd) * cost.wave.busiest()),
      milliseconds(per_unit * cost.wave.texture_cycles),
      // A compute unit's shared memory moves 32 words a cycle.
      milliseconds(per_unit * cost.wave.shared_words * wave / 32), 0.0, 0.0,
      milliseconds(
          std::ceil(per_simd / std::max(cost.waves_per_simd, 1.0)) *
          wave_latency(statistics, cost.wave, cost.waves_per_simd, shader.wave, !loops.empty()))};
  cost.dispatch_ms = 1e3 * part.dispatch_seconds;
  if (assumptions != nullptr) add_caches(part, work, *assumptions, pixels, cost);
  return cost;
}

// Returns the cost of a dispatch, which is kept until the process ends: frames of all states, and
// settings that differ little, have passes in common, that run one pipeline on the same images.
Result<ModelledPass> model_once(const GpuPart& part, const NullDevice& device,
                                const CostInputs& inputs, const AlcoveWork& frame,
                                const AlcoveWorkDispatch& dispatch, FrameState state,
                                const CacheAssumptions* assumptions) {
  static std::map<std::string, ModelledPass> known;
  std::string key = fmt::format("{} {} {} {} {} {}", part.name, fmt::ptr(assumptions), inputs.width,
                                inputs.height, dispatch.shader, dispatch.label);
  for (const std::uint32_t groups : dispatch.groups) key += fmt::format(" {}", groups);
  for (const AlcoveWorkConstant& constant :
       std::span(dispatch.constants).first(dispatch.constant_count))
    key += fmt::format(" {}", constant.value);
  for (const PassImage& image : dispatch_images(frame, dispatch)) {
    key += fmt::format(" {} {} {} {}x{}", image.name, static_cast<int>(image.direction),
                       image.texel_bytes, image.width, image.height);
  }
  if (const auto found = known.find(key); found != known.end()) return found->second;
  auto modelled = model(part, device, inputs, frame, dispatch, state, assumptions);
  if (modelled) known.emplace(std::move(key), *modelled);
  return modelled;
}

}  // namespace

std::string_view ModelledPass::limit() const {
  return kLimitNames.at(
      static_cast<std::size_t>(std::ranges::max_element(limits_ms) - limits_ms.begin()));
}

double ModelledFrame::milliseconds() const {
  double sum = 0;
  for (const ModelledPass& pass : passes) sum += pass.milliseconds();
  return sum;
}

Result<ModelledFrame> modelled_frame(const GpuPart& part, const NullDevice& device,
                                     const CostInputs& inputs, FrameState state,
                                     const CacheAssumptions* assumptions) {
  ALCOVE_TRY(const auto frames, describe_frames(inputs));
  const AlcoveWork& frame = frames.at(static_cast<std::size_t>(state));
  ModelledFrame cost{state, {}};
  for (const AlcoveWorkDispatch& dispatch :
       std::span(frame.dispatches).first(frame.dispatch_count)) {
    ALCOVE_TRY(auto pass, model_once(part, device, inputs, frame, dispatch, state, assumptions));
    cost.passes.push_back(std::move(pass));
  }
  return cost;
}

Result<std::vector<ModelledFrame>> modelled_frames(const GpuPart& part, const NullDevice& device,
                                                   const CostInputs& inputs,
                                                   const CacheAssumptions* assumptions) {
  std::vector<ModelledFrame> costs;
  for (std::size_t i = 0; i < kFrameStates; ++i) {
    ALCOVE_TRY(auto cost,
               modelled_frame(part, device, inputs, static_cast<FrameState>(i), assumptions));
    costs.push_back(std::move(cost));
  }
  return costs;
}

Result<std::vector<Occupancy>> occupancies(const GpuPart& part, const NullDevice& device,
                                           CostInputs inputs) {
  std::vector<Occupancy> found;
  for (std::size_t kind = 0; kind < kProjectionNames.size(); ++kind) {
    inputs.projection = static_cast<ProjectionKind>(kind);
    ALCOVE_TRY(const auto frames, describe_frames(inputs));
    for (const AlcoveWork& frame : frames) {
      for (const AlcoveWorkDispatch& dispatch :
           std::span(frame.dispatches).first(frame.dispatch_count)) {
        ALCOVE_TRY(const auto shader, compile_dispatch(device, dispatch));
        ALCOVE_TRY(const auto statistics, read_statistics(*shader));
        auto own = std::ranges::find(found, std::string_view(dispatch.label), &Occupancy::pass);
        if (own == found.end()) own = found.insert(own, Occupancy{dispatch.label});
        const double held = waves_held(part, statistics, shader->wave);
        double& waves = own->waves_per_simd[kind];
        waves = waves == 0 ? held : std::min(waves, held);
        double& registers = own->vector_registers[kind];
        registers = std::max(registers, statistics.vector_registers);
        own->spills[kind] = std::max(own->spills[kind], statistics.spills);
      }
    }
  }
  return found;
}

}  // namespace alcove::sample
