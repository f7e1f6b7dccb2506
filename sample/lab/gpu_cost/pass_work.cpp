#include "gpu_cost/pass_work.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace alcove::sample {
namespace {

using Loops = std::span<const CompiledLoop>;

// Assumed number of ends of occluder runs in a half-slice, at each of which a GGX lobe is
// integrated. The actual number depends on the scene.
constexpr double kOccluderRuns = 2.5;

// The numbers of depth samples that follow from the settings. A loop is identified by its number of
// image loads, because compilers unroll some loops, so that the nesting depth of a loop does not
// identify it.
struct Samples {
  std::uint32_t loads_per_step = 1;       // image loads of one step in one depth layer
  std::uint32_t steps_per_iteration = 1;  // of the loop over steps, kUnrolled of gtao_search_line.h
  std::uint32_t iterations = 1;           // of the loop over steps
  std::uint32_t half_slice = 1;           // image loads of a half-slice
  // Image loads of a half-slice whose loops over steps are unrolled. A texel of back faces that
  // both depth layers need is then loaded once.
  std::uint32_t unrolled_half_slice = 1;
  // Image loads of a half-slice that shares them in the steps outside of its loops only.
  std::uint32_t rolled_half_slice = 1;
};

Samples samples_of(const OcclusionSettings& settings) {
  const bool connected = settings.estimator == ALCOVE_ESTIMATOR_CONNECTED;
  Samples samples;
  samples.loads_per_step = passes::needs_back_depth(settings) ? 2 : 1;
  samples.half_slice =
      settings.steps * samples.loads_per_step * (passes::needs_second_depth(settings) ? 2 : 1);
  samples.unrolled_half_slice = settings.steps * ((passes::needs_back_depth(settings) ? 1 : 0) +
                                                  (passes::needs_second_depth(settings) ? 2 : 1));
  samples.steps_per_iteration = connected ? (settings.slices > 1 ? 2 : 4) : 1;
  // With connected samples the first two steps, and a remainder, are outside of the loop.
  samples.iterations =
      connected ? (settings.steps - 2) / samples.steps_per_iteration : settings.steps;
  const std::uint32_t rolled = samples.iterations * samples.steps_per_iteration;
  samples.rolled_half_slice =
      (rolled * samples.half_slice + (settings.steps - rolled) * samples.unrolled_half_slice) /
      settings.steps;
  return samples;
}

std::optional<double> sampling_iterations(const OcclusionSettings& settings, Loops loops,
                                          std::uint32_t index);

// Image loads in one iteration of a loop, those of its inner loops as often as they run.
std::optional<double> loads_per_iteration(const OcclusionSettings& settings, Loops loops,
                                          std::uint32_t index) {
  const CompiledLoop& loop = loops[index];
  double loads = loop.loads;
  for (std::uint32_t i = index + 1; i < loops.size() && loops[i].depth > loop.depth; ++i) {
    const CompiledLoop& inner = loops[i];
    if (inner.depth != loop.depth + 1 || inner.loads == 0) continue;
    const auto times = sampling_iterations(settings, loops, i);
    const auto inside = times ? loads_per_iteration(settings, loops, i) : std::nullopt;
    if (!inside) return std::nullopt;
    loads += *times * *inside - inner.loads;
  }
  return loads;
}

// Returns how often a loop with image loads runs: once for each step of a half-slice, each of the
// two half-slices of a slice, or each slice of a pixel. Its number of loads decides which of these
// loops it is.
std::optional<double> sampling_iterations(const OcclusionSettings& settings, Loops loops,
                                          std::uint32_t index) {
  const Samples samples = samples_of(settings);
  const auto loads = loads_per_iteration(settings, loops, index);
  if (!loads) return std::nullopt;
  for (const std::uint32_t half_slice :
       {samples.half_slice, samples.unrolled_half_slice, samples.rolled_half_slice}) {
    if (*loads == half_slice) return 2.0;
    if (*loads == 2.0 * half_slice) return settings.slices;
  }
  if (*loads == samples.steps_per_iteration * samples.loads_per_step) return samples.iterations;
  return std::nullopt;
}

// gtao.comp. With back faces there is a loop over the ends of occluder runs.
std::optional<double> gtao_iterations(const OcclusionSettings& settings, Loops loops,
                                      std::uint32_t index) {
  if (loops[index].loads == 0)
    return passes::needs_back_depth(settings) ? std::optional(kOccluderRuns) : std::nullopt;
  return sampling_iterations(settings, loops, index);
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

Result<std::vector<double>> loop_iterations(const PassWork& work, Loops loops) {
  std::vector<double> found;
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    const CompiledLoop& loop = loops[i];
    const std::optional<double> known =
        work.pass == "gtao"          ? gtao_iterations(work.settings, loops, i)
        : work.pass == "reconstruct" ? std::optional(reconstruct_iterations(work.settings, loop))
                                     : std::nullopt;
    if (!known) {
      std::string message =
          "The pass '" + std::string(work.pass) + "' (" + std::string(name_of(work.state)) +
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
  constexpr std::uint32_t kMostInstructions = 300;
  const bool from_depth =
      (branch.loads == 8 || branch.loads == 9) && branch.instructions < kMostInstructions;
  const bool given =
      std::ranges::find(work.images, "normals", &PassImage::name) != work.images.end();
  if (work.pass == "reconstruct" && has_depth_planes(work) &&
      (given ? branch.loads == 1 : from_depth))
    return kBentDepth;
  return from_depth ? kNormalFromDepth : 1.0;
}

}  // namespace alcove::sample
