// The directions of slices and the offsets of steps for each pixel and frame.
//
// The pattern gives a pixel two numbers in [0,1). `direction` is a fraction of the angle between
// slices: slice k of n lies at phi = pi (k + direction) / n. `offset` is a fraction of a step.
#ifndef ALCOVE_MATHS_SAMPLING_H
#define ALCOVE_MATHS_SAMPLING_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

struct SliceNoise {
  float direction;
  float offset;
};

ALCOVE_INLINE float slice_angle(uint slice, uint slice_count, float direction) {
  return kPi * (float(slice) + direction) / float(slice_count);
}

// Returns a hash of a position, by multiplications and xor-shifts with the primes of xxHash
// [Collet 2012].
ALCOVE_INLINE uint hash_of(uvec2 position) {
  uint bits = (position.x * 2654435761u) ^ (position.y * 2246822519u);
  bits = (bits ^ (bits >> 15u)) * 3266489917u;
  return bits ^ (bits >> 16u);
}

// Directions that are even over few adjacent pixels and over successive frames
// (passes/ALGORITHM.md, "Sampling, filter and history"). If `moves` is true, `pixel` is the number
// of a tile, and any 2x2 tiles have one direction in each quarter of the range. If it is false,
// each pixel is traced in every frame, and directions are a lattice over each block of 4x4 pixels.
ALCOVE_INLINE SliceNoise golden_pattern(uvec2 pixel, uint frame, bool moves) {
  // Rotations per frame as fractions of 2^32, exact for every frame: those of 1.6180339887 and
  // 0.7548776662, or, if `moves` is true, a quarter of 1.6180339887 and of 2.5698402910.
  uint direction_rotation = moves ? 1737350766u : 2654435769u;
  uint offset_rotation = moves ? 2759345001u : 3242174889u;
  uint direction_bits = frame * direction_rotation;
  if (moves) {
    // The quarters of 2x2 tiles: 0 and 2 above, 3 and 1 below.
    uint below = pixel.y & 1u;
    uint quarter = (((pixel.x ^ pixel.y) & 1u) << 1u) | below;
    direction_bits += (quarter << 30u) + (hash_of(pixel) >> 2u);
  } else {
    // Steps to the right and downwards: 0.7548776662 and 0.5698402910.
    direction_bits += hash_of(uvec2(pixel.x >> 2u, pixel.y >> 2u)) + pixel.x * 3242174889u +
                      pixel.y * 2447445414u;
  }
  // Steps to the right and downwards: 0.6180339887 and 0.4142135624.
  uint offset_bits =
      (1u << 29u) + pixel.x * 2654435769u + pixel.y * 1779033704u + frame * offset_rotation;
  SliceNoise noise;
  noise.direction = float(direction_bits >> 8u) * (1.0f / 16777216.0f);
  noise.offset = float(offset_bits >> 8u) * (1.0f / 16777216.0f);
  return noise;
}

// The distance in pixels of the nearest sample, which in every direction lies on another texel than
// the shaded one.
const float kNearestStep = 1.3f;

ALCOVE_MATHS_END

#endif
