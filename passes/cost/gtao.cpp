// Loops of shaders/gtao.comp.
#include "pass_work.h"

namespace alcove::passes::cost {
namespace {

// Assumed number of ends of occluder runs in a half-slice, at each of which a GGX lobe is
// integrated. The actual number depends on the scene.
constexpr double kOccluderRuns = 2.5;

// The numbers of depth samples that follow from the settings. A loop is identified by its number of
// image loads, because compilers unroll some loops, so that the nesting depth of a loop does not
// identify it.
struct Samples {
  std::uint32_t loads_per_step = 1;       // image loads of one step in one depth layer
  std::uint32_t steps_per_iteration = 1;  // of the loop over steps, kUnrolled of gtao.comp
  std::uint32_t iterations = 1;           // of the loop over steps
  std::uint32_t half_slice = 1;           // image loads of a half-slice
};

Samples samples_of(const OcclusionSettings& settings) {
  const bool connected = settings.advanced.estimator == Estimator::connected;
  Samples samples;
  samples.loads_per_step = needs_back_depth(settings) ? 2 : 1;
  samples.half_slice =
      settings.steps * samples.loads_per_step * (needs_second_depth(settings) ? 2 : 1);
  samples.steps_per_iteration = connected ? (settings.slices > 1 ? 2 : 4) : 1;
  // With connected samples the first two steps, and a remainder, are outside of the loop.
  samples.iterations =
      connected ? (settings.steps - 2) / samples.steps_per_iteration : settings.steps;
  return samples;
}

std::optional<double> sampling_iterations(const PassWork& work, std::uint32_t index);

// Image loads in one iteration of a loop, those of its inner loops as often as they run.
std::optional<double> loads_per_iteration(const PassWork& work, std::uint32_t index) {
  const CompiledLoop& loop = work.loops[index];
  double loads = loop.loads;
  for (std::uint32_t i = index + 1; i < work.loops.size() && work.loops[i].depth > loop.depth;
       ++i) {
    const CompiledLoop& inner = work.loops[i];
    if (inner.depth != loop.depth + 1 || inner.loads == 0) {
      continue;
    }
    const auto times = sampling_iterations(work, i);
    const auto inside = times ? loads_per_iteration(work, i) : std::nullopt;
    if (!inside) {
      return std::nullopt;
    }
    loads += *times * *inside - inner.loads;
  }
  return loads;
}

// Returns how often a loop with image loads runs: once for each step of a half-slice, each of the
// two half-slices of a slice, or each slice of a pixel. Its number of loads decides which of these
// loops it is.
std::optional<double> sampling_iterations(const PassWork& work, std::uint32_t index) {
  const Samples samples = samples_of(work.settings);
  const auto loads = loads_per_iteration(work, index);
  if (!loads) {
    return std::nullopt;
  }
  if (*loads == samples.half_slice) {
    return 2.0;
  }
  if (*loads == 2.0 * samples.half_slice) {
    return work.settings.slices;
  }
  if (*loads == samples.steps_per_iteration * samples.loads_per_step) {
    return samples.iterations;
  }
  return std::nullopt;
}

// Whether a loop over the ends of occluder runs exists.
bool integrates_runs(const OcclusionSettings& settings) {
  return settings.advanced.estimator == Estimator::bitmask || needs_back_depth(settings);
}

}  // namespace

std::optional<double> gtao_iterations(const PassWork& work, const CompiledLoop& loop) {
  if (loop.loads == 0) {
    return integrates_runs(work.settings) ? std::optional(kOccluderRuns) : std::nullopt;
  }
  return sampling_iterations(work, loop.index);
}

}  // namespace alcove::passes::cost
