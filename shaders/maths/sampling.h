// The directions of slices and the offsets of steps for each pixel and frame.
//
// Each pattern gives a pixel two numbers in [0,1). `direction` is a fraction of the angle between
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

// Returns the paper's pattern (section 4.4). A block of 4x4 pixels has 16 directions and 4 offsets.
// In each of six frames the directions are rotated by another multiple of a sixth of 180 degrees,
// which gives 96 different directions. The order of the multiples keeps successive frames of a
// pixel far apart. Every second rotation is shifted by 1/96 of 180 degrees, so that no two of the
// 96 coincide.
ALCOVE_INLINE SliceNoise paper_pattern(uvec2 pixel, uint frame) {
  uint x = pixel.x & 3u;
  uint y = pixel.y & 3u;
  uint cell = (((x + y) & 3u) << 2u) + x;
  // The rotations in sixths of 180 degrees, in the order 1, 5, 3, 4, 2, 0, with four bits each.
  uint sixth = (0x024351u >> ((frame % 6u) * 4u)) & 15u;
  uint step_of_96 = (cell * 6u + sixth * 16u + (sixth & 1u)) % 96u;
  // The offsets in quarters of a step, in the order 0, 2, 1, 3, with two bits each. The offset
  // changes after every six frames.
  uint quarter = (0xD8u >> (((frame / 6u) & 3u) * 2u)) & 3u;
  uint offset = ((y + 4u - x) & 3u) * 4u + quarter;
  SliceNoise noise;
  noise.direction = float(step_of_96) * (1.0f / 96.0f);
  noise.offset = (float(offset) + 0.5f) * (1.0f / 16.0f);
  return noise;
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

// Returns the position, 0 to 4095, along a Hilbert curve through 64x64 pixels. x and y are taken
// modulo 64.
ALCOVE_INLINE uint hilbert_index(uvec2 pixel) {
  uint x = pixel.x & 63u;
  uint y = pixel.y & 63u;
  uint index = 0u;
  for (uint size = 32u; size > 0u; size >>= 1u) {
    uint right = (x & size) != 0u ? 1u : 0u;
    uint below = (y & size) != 0u ? 1u : 0u;
    index += size * size * ((3u * right) ^ below);
    if (below == 0u) {
      uint mirror = right * 63u;
      uint swapped = x ^ mirror;
      x = y ^ mirror;
      y = swapped;
    }
  }
  return index;
}

// The R2 sequence (Roberts 2018) in 32-bit fixed point, exact for every index.
ALCOVE_INLINE SliceNoise r2_sequence(uint index) {
  SliceNoise noise;
  noise.direction = float((0x80000000u + index * 3242174889u) >> 8u) * (1.0f / 16777216.0f);
  noise.offset = float((0x80000000u + index * 2447445414u) >> 8u) * (1.0f / 16777216.0f);
  return noise;
}

// Returns the element of the R2 sequence whose index is the pixel's position along a Hilbert curve.
// The pattern repeats after 64 frames. Neighbouring pixels and successive frames get evenly
// distributed values, as a spatial filter followed by a temporal one needs them.
ALCOVE_INLINE SliceNoise hilbert_pattern(uvec2 pixel, uint frame) {
  return r2_sequence(hilbert_index(pixel) + 288u * (frame & 63u));
}

// The distance in pixels of the nearest sample, which in every direction lies on another texel than
// the shaded one.
const float kNearestStep = 1.3f;

ALCOVE_MATHS_END

#endif
