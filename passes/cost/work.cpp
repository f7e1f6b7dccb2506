#include "work.h"

#include <array>
#include <optional>
#include <string>

#include "pass_work.h"

namespace alcove::passes::cost {
namespace {

std::optional<double> known_iterations(const PassWork& work, const CompiledLoop& loop) {
  if (work.pass == "gtao") {
    return gtao_iterations(work, loop);
  }
  if (work.pass == "reconstruct") {
    return reconstruct_iterations(work, loop);
  }
  return std::nullopt;
}

}  // namespace

std::string_view name_of(FrameState state) {
  constexpr std::array<std::string_view, kFrameStates> kNames{"first", "moving", "static",
                                                              "converged"};
  return kNames[static_cast<std::size_t>(state)];
}

tl::expected<double, std::string> iterations(const PassWork& work, const CompiledLoop& loop) {
  if (const std::optional<double> known = known_iterations(work, loop)) {
    return *known;
  }
  return tl::unexpected("The pass '" + std::string(work.pass) + "' (" +
                        std::string(name_of(work.state)) +
                        " frame) has a loop whose number of iterations is not declared: loop " +
                        std::to_string(loop.index) + " at depth " + std::to_string(loop.depth) +
                        ", with " + std::to_string(loop.instructions) + " instructions, " +
                        std::to_string(loop.loads) + " image loads and " +
                        std::to_string(loop.stores) + " image stores; declare it in passes/cost.");
}

// seen_normal() computes a normal from depth if the given normal is missing or seems to face away
// from the eye by a little. It loads the depth of a pixel and of its four neighbours.
double branch_share(const PassWork& /*work*/, const CompiledBranch& branch) {
  // An assumption about the share of the groups of 8x8 pixels with such a pixel; it is zero with
  // the triangles' own normals, except at silhouettes.
  constexpr double kNormalFromDepth = 0.02;
  const bool normal_from_depth =
      branch.stores == 0 && branch.loops == 0 && (branch.loads == 4 || branch.loads == 5);
  return normal_from_depth ? kNormalFromDepth : 1.0;
}

}  // namespace alcove::passes::cost
