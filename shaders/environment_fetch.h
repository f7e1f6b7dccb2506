// Bilinear reads of octahedral environment maps with texelFetch, because the passes bind these maps
// without samplers.
#ifndef ALCOVE_ENVIRONMENT_FETCH_H
#define ALCOVE_ENVIRONMENT_FETCH_H

#include "maths/environment_map.h"

// Reads one mip at a unit direction. The interpolation continues across the edges of the map.
vec3 fetch_map_level(texture2D map, float first_size, int level, vec3 direction) {
  int size = max(int(first_size) >> level, 1);
  vec2 texel = map_uv(direction) * float(size) - 0.5;
  ivec2 low = ivec2(floor(texel));
  vec2 t = texel - vec2(low);
  vec3 low_low = texelFetch(map, map_texel(low, size), level).rgb;
  vec3 high_low = texelFetch(map, map_texel(low + ivec2(1, 0), size), level).rgb;
  vec3 low_high = texelFetch(map, map_texel(low + ivec2(0, 1), size), level).rgb;
  vec3 high_high = texelFetch(map, map_texel(low + ivec2(1, 1), size), level).rgb;
  return mix(mix(low_low, high_low, t.x), mix(low_high, high_high, t.x), t.y);
}

// Interpolates between two mips; `level` is in [0, number of mips - 1].
vec3 fetch_map(texture2D map, float first_size, float level, vec3 direction) {
  int low = int(level);
  float t = level - float(low);
  vec3 here = fetch_map_level(map, first_size, low, direction);
  return t > 0.0 ? mix(here, fetch_map_level(map, first_size, low + 1, direction), t) : here;
}

#endif
