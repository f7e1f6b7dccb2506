#include "work.h"

#include <array>
#include <optional>
#include <set>
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

double cache_lines(const LoadPattern& pattern) {
  constexpr std::int32_t kLine = 64;
  constexpr std::int32_t kGroup = 8;
  const auto texel = static_cast<std::int32_t>(pattern.texel_bytes);
  const auto pitch = static_cast<std::int32_t>(pattern.pitch);
  const auto footprint = static_cast<std::int32_t>(pattern.footprint);
  std::set<std::int32_t> rows;
  for (std::int32_t i = 0; i < kGroup * footprint; ++i) {
    rows.insert(i / footprint * pitch + i % footprint);
  }
  const std::int32_t positions = pattern.anywhere ? kLine / texel : 1;
  double lines = 0;
  for (std::int32_t position = 0; position < positions; ++position) {
    std::set<std::int32_t> of_row;
    for (const std::int32_t column : rows) {
      const std::int32_t x = column + position + pattern.first;
      of_row.insert((x * texel + kLine) / kLine);  // a group begins at most a line before its image
    }
    lines += static_cast<double>(of_row.size() * rows.size());
  }
  return lines / positions;
}

double cache_lines_per_load(const PassWork& work) {
  if (work.pass != "reconstruct") {
    return 0;
  }
  double lines = 0;
  double loads = 0;
  for (const LoadPattern& pattern : reconstruct_loads(work)) {
    lines += pattern.count * cache_lines(pattern);
    loads += pattern.count;
  }
  return lines / loads;
}

}  // namespace alcove::passes::cost
