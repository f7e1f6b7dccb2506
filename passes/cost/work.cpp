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

double traffic_share(const PassWork& work, std::string_view image, Direction direction) {
  if (work.pass == "gtao") {
    return gtao_traffic(work, image, direction);
  }
  if (work.pass == "reconstruct") {
    return reconstruct_traffic(work, image, direction);
  }
  return 1.0;
}

}  // namespace alcove::passes::cost
