// Environment images in two layouts: equirectangular, as files have them, and octahedral, as
// shaders look them up.
//
// Directions are in world space with +Y up. Equirectangular: u runs from 0 at -Z over +X (0.25), +Z
// (0.5) and -X (0.75) back to -Z; v runs from 0 at +Y to 1 at -Y. Octahedral: the square of
// octahedral.h with +Y in the middle and -Y in its four corners, so that its fold is the horizon.
// Beyond an edge of the square, the map continues with the texels of the same edge in mirrored
// order.
#ifndef ALCOVE_MATHS_ENVIRONMENT_MAP_H
#define ALCOVE_MATHS_ENVIRONMENT_MAP_H

#include "constants.h"
#include "language.h"
#include "octahedral.h"

ALCOVE_MATHS_BEGIN

ALCOVE_INLINE vec2 equirectangular_uv(vec3 direction) {
  float across = sqrt(direction.x * direction.x + direction.z * direction.z);
  float longitude = across > 0.0f ? atan(direction.x, -direction.z) / (2.0f * kPi) : 0.0f;
  return vec2(longitude < 0.0f ? longitude + 1.0f : longitude, atan(across, direction.y) / kPi);
}

// Converts a unit direction to a point in [0,1]^2 of the octahedral map, and back.
ALCOVE_INLINE vec2 map_uv(vec3 direction) {
  vec2 square = octahedral_encode(vec3(direction.x, direction.z, direction.y));
  return vec2(square.x * 0.5f + 0.5f, square.y * 0.5f + 0.5f);
}

ALCOVE_INLINE vec3 map_direction(vec2 uv) {
  vec3 d = octahedral_decode(vec2(uv.x * 2.0f - 1.0f, uv.y * 2.0f - 1.0f));
  return vec3(d.x, d.z, d.y);
}

// Returns the texel inside a map of `size` x `size` texels that has the same direction as `texel`,
// whose indices may be up to `size` texels outside the map.
ALCOVE_INLINE ivec2 map_texel(ivec2 texel, int size) {
  int x = texel.x;
  int y = texel.y;
  if (x < 0 || x >= size) {
    x = x < 0 ? -1 - x : 2 * size - 1 - x;
    y = size - 1 - y;
  }
  if (y < 0 || y >= size) {
    y = y < 0 ? -1 - y : 2 * size - 1 - y;
    x = size - 1 - x;
  }
  return ivec2(x, y);
}

// Returns the solid angle in steradians that the texel around `uv` covers in a map of `size` x
// `size` texels.
ALCOVE_INLINE float map_texel_angle(vec2 uv, float size) {
  float x = uv.x * 2.0f - 1.0f;
  float y = uv.y * 2.0f - 1.0f;
  float z = 1.0f - abs(x) - abs(y);
  float fold = max(-z, 0.0f);
  x = abs(x) - fold;
  y = abs(y) - fold;
  float squared = x * x + y * y + z * z;
  return 4.0f / (size * size * squared * sqrt(squared));
}

// Returns the mip of a prefiltered map for a perceptual roughness; roughness_of_level() is its
// inverse. The roughness grows in equal steps from 0 in the first mip to 1 in the last.
ALCOVE_INLINE float level_of_roughness(float roughness, uint levels) {
  return clamp(roughness, 0.0f, 1.0f) * float(levels - 1u);
}

ALCOVE_INLINE float roughness_of_level(uint level, uint levels) {
  return levels > 1u ? float(level) / float(levels - 1u) : 0.0f;
}

ALCOVE_MATHS_END

#endif
