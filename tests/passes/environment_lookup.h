// Reads octahedral maps on the CPU with the same interpolation as the shaders.
#pragma once

#include "maths/environment_map.h"
#include "pass_fixture.h"

namespace alcove::passes {

inline glm::vec3 rgb(const HostImage& image, std::uint32_t x, std::uint32_t y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// Returns the bilinear value of one mip at a unit direction.
inline glm::vec3 look_up(const HostImage& map, glm::vec3 direction) {
  const int size = static_cast<int>(map.width);
  const glm::vec2 texel = maths::map_uv(direction) * float(size) - 0.5f;
  const glm::ivec2 low(floor(texel));
  const glm::vec2 t = texel - glm::vec2(low);
  const auto fetch = [&](int x, int y) {
    const glm::ivec2 at = maths::map_texel(low + glm::ivec2(x, y), size);
    return rgb(map, static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
  };
  return mix(mix(fetch(0, 0), fetch(1, 0), t.x), mix(fetch(0, 1), fetch(1, 1), t.x), t.y);
}

}  // namespace alcove::passes
