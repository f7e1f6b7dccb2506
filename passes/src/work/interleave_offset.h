// The pixel of each tile that is traced in a frame, and static noise.
#pragma once

#include <array>
#include <cstdint>

#include "alcove/alcove_settings.h"

namespace alcove::passes {

struct InterleaveOffset {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};

// Returns which pixel of a tile of tile_size x tile_size pixels (1, 2, 4 or 8) is traced in a
// frame. Each pixel is traced once in tile_size^2 frames. Successive frames visit the quarters of
// the tile in the order (0,0), (1,1), (1,0), (0,1), and successive visits to a quarter visit its
// own quarters in the same order, so that successive pixels are far apart.
[[nodiscard]] constexpr InterleaveOffset interleave_offset_of(std::uint32_t tile_size,
                                                              std::uint32_t frame) {
  constexpr std::array<InterleaveOffset, 4> kOrder{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  InterleaveOffset offset;
  for (std::uint32_t half = tile_size / 2; half > 0; half /= 2) {
    offset.x += kOrder[frame % 4].x * half;
    offset.y += kOrder[frame % 4].y * half;
    frame /= 4;
  }
  return offset;
}

// Returns whether all frames have the same noise. It is that of frame kStaticNoise, which traces
// the pixel beside the centre of each tile.
[[nodiscard]] constexpr bool has_static_noise(const AlcoveSettings& settings) {
  return settings.static_noise != 0 && settings.history_frames == 0;
}
inline constexpr std::uint32_t kStaticNoise = 1;

}  // namespace alcove::passes
