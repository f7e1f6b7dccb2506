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

// Lattices over the image whose steps from pixel to pixel are irrational. They are rotated from
// frame to frame by the golden ratio (directions) and by an R2 number (offsets). Few adjacent
// pixels cover directions and offsets evenly, and so do successive frames at one pixel. The
// directions step by the two numbers of the R2 sequence [Roberts 2018], the offsets by the golden
// ratio and the square root of 2.
//
// The error of a pixel depends on the direction of its slices. A lattice over the whole image would
// show each harmonic of this dependence as waves of one length, which the spatial filter and few
// frames do not remove. The directions of each block of 4x4 pixels are therefore shifted by a
// random amount, which is constant over time. A block still covers all directions evenly.
//
// If `moves` is true, the traced pixel moves through the pixels of a tile and returns after four
// frames. The rotation per frame is then a quarter of such a number, so that the frames in which a
// pixel itself is traced cover directions and offsets evenly.
ALCOVE_INLINE SliceNoise golden_pattern(uvec2 pixel, uint frame, bool moves) {
  // Rotations per frame, of the directions and of the offsets, as fractions of
  // 2^32, so that they are exact for every frame. The fractions are those of 1.6180339887 and
  // 0.7548776662, or, if `moves` is true, a quarter of 1.6180339887 and of 2.5698402910.
  uint direction_rotation = moves ? 1737350766u : 2654435769u;
  uint offset_rotation = moves ? 2759345001u : 3242174889u;
  uint random_shift = hash_of(uvec2(pixel.x >> 2u, pixel.y >> 2u));
  // Steps to the right and downwards: 0.7548776662 and 0.5698402910 for directions, 0.6180339887
  // and 0.4142135624 for offsets.
  uint direction_bits =
      random_shift + pixel.x * 3242174889u + pixel.y * 2447445414u + frame * direction_rotation;
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
