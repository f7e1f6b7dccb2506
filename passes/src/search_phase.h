// Which pixel of a block is searched in a frame.
#pragma once

#include <array>
#include <cstdint>

namespace alcove::passes {

struct SearchPhase {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};

// Every pixel of a block of divisor x divisor (1, 2 or 4) once in divisor^2 frames, those that
// follow each other far apart: (0,0), (1,1), (1,0), (0,1), and the same within each quarter of 4x4.
[[nodiscard]] constexpr SearchPhase search_phase(std::uint32_t divisor, std::uint32_t frame) {
  constexpr std::array<SearchPhase, 4> kOrder{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  if (divisor == 1) {
    return {};
  }
  const SearchPhase coarse = kOrder[frame % 4];
  if (divisor == 2) {
    return coarse;
  }
  const SearchPhase fine = kOrder[frame / 4 % 4];
  return {coarse.x * 2 + fine.x, coarse.y * 2 + fine.y};
}

}  // namespace alcove::passes
