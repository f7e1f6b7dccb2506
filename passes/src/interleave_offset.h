// The pixel of each tile that is traced in a frame.
#pragma once

#include <array>
#include <cstdint>

namespace alcove::passes {

struct InterleaveOffset {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};

// Returns the pixel of a tile of tile_size x tile_size pixels (1, 2 or 4) that is traced in a
// frame. Each pixel is traced once in tile_size^2 frames, and successive pixels are far apart. The
// order in 2x2 is (0,0), (1,1), (1,0), (0,1). In 4x4, that order selects the quarter of the tile
// and then the pixel of the quarter.
[[nodiscard]] constexpr InterleaveOffset interleave_offset_of(std::uint32_t tile_size,
                                                              std::uint32_t frame) {
  constexpr std::array<InterleaveOffset, 4> kOrder{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  if (tile_size == 1) {
    return {};
  }
  const InterleaveOffset coarse = kOrder[frame % 4];
  if (tile_size == 2) {
    return coarse;
  }
  const InterleaveOffset fine = kOrder[frame / 4 % 4];
  return {coarse.x * 2 + fine.x, coarse.y * 2 + fine.y};
}

}  // namespace alcove::passes
