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

// Directions that are even over few adjacent pixels and over successive frames of a pixel.
//
// If `moves` is false, directions and offsets are lattices over the image whose steps from pixel to
// pixel are irrational: the two numbers of the R2 sequence [Roberts 2018] for directions, the
// golden ratio and the square root of 2 for offsets. Frames rotate them by the golden ratio
// (directions) and by an R2 number (offsets). The error of a pixel depends on the direction of its
// slices, and a lattice over the whole image would show each harmonic of this dependence as waves
// of one length. The directions of each block of 4x4 pixels are therefore shifted by a random
// amount, which is constant over time.
//
// If `moves` is true, a pixel is that of a tile, the traced pixel moves through the pixels of the
// tile, and the filter averages 2x2 tiles. The four tiles of any 2x2 then have one direction in
// each quarter of the range, wherever the 2x2 begin. Within its quarter a tile has a random
// direction, which is constant over time. When the camera moves, a surface is seen by other tiles
// in each frame, and blocks whose borders it crosses would not give it even directions. The
// rotation per frame is a quarter of the golden ratio, so that the frames in which a pixel itself
// is traced, every fourth, cover directions evenly; modulo a quarter of the range it is a quarter
// of the golden ratio's fraction, so that successive frames fill the quarters evenly whichever tile
// sees the surface.
ALCOVE_INLINE SliceNoise golden_pattern(uvec2 pixel, uint frame, bool moves) {
  // Rotations per frame, of the directions and of the offsets, as fractions of
  // 2^32, so that they are exact for every frame. The fractions are those of 1.6180339887 and
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
