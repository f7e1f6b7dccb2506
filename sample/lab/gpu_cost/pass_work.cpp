#include "gpu_cost/pass_work.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace alcove::sample {
namespace {

using Loops = std::span<const CompiledLoop>;

// Assumed number of ends of occluder runs in a half-slice, at each of which a GGX lobe is
// integrated. The actual number depends on the scene.
constexpr double kOccluderRuns = 2.5;

// The depth samples of gtao.comp. A loop is identified by its number of image loads, because
// compilers unroll some loops, so that the nesting depth of a loop does not identify it.
struct Samples {
  std::uint32_t slices = 1;
  std::uint32_t half_slice = 1;     // image loads of a half-slice
  std::uint32_t per_iteration = 1;  // image loads of an iteration of the loops over steps
  // How often the loops over steps of a half-slice run: one for each layer, without those that the
  // compiler unrolled.
  std::vector<std::uint32_t> iterations;
};

// `layers` is the number of layers whose loops over steps are not unrolled.
Samples samples_of(const OcclusionSettings& settings, std::size_t layers) {
  const bool connected = settings.estimator == ALCOVE_ESTIMATOR_CONNECTED;
  // kUnrolled of gtao_search_line.h
  const std::uint32_t steps_per_iteration = connected ? (settings.slices > 1 ? 2 : 4) : 1;
  const std::uint32_t loads_per_step = passes::needs_back_depth(settings) ? 2 : 1;
  const std::array<std::uint32_t, 2> steps{settings.steps, passes::second_layer_steps(settings)};
  Samples samples{settings.slices,
                  (steps[0] + steps[1]) * loads_per_step,
                  steps_per_iteration * loads_per_step,
                  {}};
  // With connected samples the first two steps, and a remainder, are outside of the loop.
  for (std::size_t i = 0; i < layers; ++i)
    samples.iterations.push_back((steps.at(i) - (connected ? 2 : 0)) / steps_per_iteration);
  return samples;
}

std::optional<double> sampling_iterations(const Samples& samples, Loops loops, std::size_t index);

// Image loads in one iteration of a loop, those of its inner loops as often as they run.
std::optional<double> loads_per_iteration(const Samples& samples, Loops loops, std::size_t index) {
  const CompiledLoop& loop = loops[index];
  double loads = loop.loads;
  for (std::size_t i = index + 1; i < loops.size() && loops[i].depth > loop.depth; ++i) {
    const CompiledLoop& inner = loops[i];
    if (inner.depth != loop.depth + 1 || inner.loads == 0) continue;
    const auto times = sampling_iterations(samples, loops, i);
    const auto inside = times ? loads_per_iteration(samples, loops, i) : std::nullopt;
    if (!inside) return std::nullopt;
    loads += *times * *inside - inner.loads;
  }
  return loads;
}

// Returns how often a loop with image loads runs: once for each slice of a pixel, each of the two
// half-slices of a slice, or each few steps of a half-slice in one layer. Its number of loads
// decides which of these loops it is. The loops of the layers follow one another.
std::optional<double> sampling_iterations(const Samples& samples, Loops loops, std::size_t index) {
  const auto loads = loads_per_iteration(samples, loops, index);
  if (!loads) return std::nullopt;
  if (*loads == samples.half_slice) return 2.0;
  if (*loads == 2.0 * samples.half_slice) return samples.slices;
  if (*loads != samples.per_iteration || samples.iterations.empty()) return std::nullopt;
  std::size_t before = 0;
  while (before < index && loops[index - before - 1].depth == loops[index].depth) ++before;
  return samples.iterations[before % samples.iterations.size()];
}

// gtao.comp. The counts of its loops must add up to the samples of a half-slice, which tells which
// loops over steps the compiler unrolled. With back faces there is a loop over the ends of occluder
// runs.
std::optional<double> gtao_iterations(const OcclusionSettings& settings, Loops loops,
                                      std::size_t index) {
  if (loops[index].loads == 0)
    return passes::needs_back_depth(settings) ? std::optional(kOccluderRuns) : std::nullopt;
  for (const std::size_t layers : {2, 1, 0}) {
    const Samples samples = samples_of(settings, layers);
    bool all_known = true;
    for (std::size_t i = 0; i < loops.size(); ++i)
      all_known = all_known && (loops[i].loads == 0 || sampling_iterations(samples, loops, i));
    if (all_known) return sampling_iterations(samples, loops, index);
  }
  return std::nullopt;
}

// reconstruct.comp. The outermost loop runs over the blocks of a column. The loops of sum_wide()
// are counted as not run: pixels with a history run them only while it is less than two frames old,
// which is rare.
double reconstruct_iterations(const OcclusionSettings& settings, const CompiledLoop& loop) {
  const bool column = settings.tile_size > (settings.half_resolution ? 2u : 1u);
  return column && loop.depth == 1 ? 4.0 : 0.0;
}

}  // namespace

std::string_view name_of(FrameState state) {
  constexpr std::array<std::string_view, kFrameStates> kNames{"first", "moving", "static",
                                                              "converged"};
  return kNames[static_cast<std::size_t>(state)];
}

Result<Pass> pass_of(std::string_view label) {
  const auto found = std::ranges::find(kPassLabels, label);
  if (found == kPassLabels.end()) {
    return Failure("The cost model has no facts about the pass '" + std::string(label) +
                   "'; declare it in sample/lab/gpu_cost/pass_work.h and accesses.cpp.");
  }
  return static_cast<Pass>(found - kPassLabels.begin());
}

Result<std::vector<double>> loop_iterations(const PassWork& work, Loops loops) {
  std::vector<double> found;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const CompiledLoop& loop = loops[i];
    const std::optional<double> known =
        work.pass == Pass::gtao ? gtao_iterations(work.settings, loops, i)
        : work.pass == Pass::reconstruct
            ? std::optional(reconstruct_iterations(work.settings, loop))
            : std::nullopt;
    if (!known) {
      std::string message =
          "The pass '" + std::string(kPassLabels.at(static_cast<std::size_t>(work.pass))) + "' (" +
          std::string(name_of(work.state)) +
          " frame) has a loop whose number of iterations is not declared: loop " +
          std::to_string(i) + "; declare it in sample/lab/gpu_cost/pass_work.cpp. Its loops:";
      for (const CompiledLoop& each : loops) {
        message += " depth " + std::to_string(each.depth) + " with " +
                   std::to_string(each.instructions) + " instructions and " +
                   std::to_string(each.loads) + " image loads;";
      }
      return tl::unexpected(std::move(message));
    }
    found.push_back(*known);
  }
  return found;
}

bool has_depth_planes(const PassWork& work) {
  return !work.settings.half_resolution && work.settings.history_frames > 0 &&
         work.state != FrameState::first && work.settings.specular != ALCOVE_SPECULAR_SLICES;
}

// The branches that read a normal or compute it from depth, which loads the depth of the pixel and
// of eight neighbours.
double branch_share(const PassWork& work, const CompiledBranch& branch) {
  // seen_normal(): an assumption about the share of the groups of 8x8 pixels with a pixel whose
  // given normal is missing or seems to face away from the eye by a little. It is zero with the
  // triangles' own normals, except at silhouettes.
  constexpr double kNormalFromDepth = 0.02;
  if (branch.stores > 0 || branch.shared > 0 || branch.loops > 0) return 1.0;
  // A half-slice of eight samples loads as much, but takes more instructions.
  constexpr double kMostInstructions = 300;
  const bool from_depth =
      (branch.loads == 8 || branch.loads == 9) && branch.instructions < kMostInstructions;
  const bool given =
      std::ranges::find(work.images, names::kNormals, &PassImage::name) != work.images.end();
  if (work.pass == Pass::reconstruct && has_depth_planes(work) &&
      (given ? branch.loads == 1 : from_depth))
    return kBentDepth;
  return from_depth ? kNormalFromDepth : 1.0;
}

}  // namespace alcove::sample
