// The two numbers that a search leaves at a pixel, and its depth, in 8 bytes.
//
// Filters and history add up visible parts and open parts and divide last. What is stored is their
// ratio, so that an open surface stays open to the last bit, and the open part.
#ifndef ALCOVE_MATHS_SIGNAL_H
#define ALCOVE_MATHS_SIGNAL_H

#include "language.h"

ALCOVE_MATHS_BEGIN

struct Signal {
  float visible;  // visible part of the slices, [0,open]
  float open;     // all of them, [0,kLargestOpen]
};

// Of a mean over slices, and of one weighted by a filter's window.
const float kLargestOpen = 4.0f;

// To 2^-17 of the ratio and 2^-15 of the open part; out of range comes out as the nearest in range.
ALCOVE_INLINE uint pack_signal(Signal signal) {
  float ratio = signal.open > 0.0f ? signal.visible / signal.open : 1.0f;
  return packUnorm2x16(vec2(ratio, signal.open * (1.0f / kLargestOpen)));
}

ALCOVE_INLINE Signal unpack_signal(uint bits) {
  Signal signal;
  signal.open = float(bits >> 16u) * (kLargestOpen / 65535.0f);
  signal.visible = float(bits & 0xffffu) * (1.0f / 65535.0f) * signal.open;
  return signal;
}

// A sum of visible directions, each component within 2^-11 of itself.
ALCOVE_INLINE uvec2 pack_direction(vec3 direction) {
  return uvec2(packHalf2x16(vec2(direction.x, direction.y)), packHalf2x16(vec2(direction.z, 0.0f)));
}

ALCOVE_INLINE vec3 unpack_direction(uvec2 bits) {
  return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x);
}

ALCOVE_MATHS_END

#endif
