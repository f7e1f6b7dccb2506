// The two numbers that a search leaves at a pixel, and its depth, in 8 bytes.
//
// Filters and history add up visible parts and open parts and divide last. What is stored is their
// ratio, so that an open surface stays open to the last bit, and the open part.
#ifndef ALCOVE_MATHS_SIGNAL_H
#define ALCOVE_MATHS_SIGNAL_H

#include "language.h"
#include "octahedral.h"

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

// The same of a GGX lobe, in parts that differ by orders of magnitude from slice to slice: the
// ratio to 2^-17, the open part, [0,65504], as a half.
ALCOVE_INLINE uint pack_lobe(Signal lobe) {
  float ratio = lobe.open > 0.0f ? clamp(lobe.visible / lobe.open, 0.0f, 1.0f) : 1.0f;
  return uint(ratio * 65535.0f + 0.5f) | (packHalf2x16(vec2(min(lobe.open, 65504.0f), 0.0f)) << 16u);
}

ALCOVE_INLINE Signal unpack_lobe(uint bits) {
  Signal lobe;
  lobe.open = unpackHalf2x16(bits >> 16u).x;
  lobe.visible = float(bits & 0xffffu) * (1.0f / 65535.0f) * lobe.open;
  return lobe;
}

// The surface that a lobe belongs to, for filters: a unit normal to 0.5 degrees and a perceptual
// roughness to 2^-9.
struct LobeSurface {
  vec3 normal;
  float roughness;
};

ALCOVE_INLINE uint pack_lobe_surface(LobeSurface surface) {
  vec2 square = octahedral_encode(surface.normal) * 0.5f + 0.5f;
  return uint(clamp(square.x, 0.0f, 1.0f) * 4095.0f + 0.5f) |
         (uint(clamp(square.y, 0.0f, 1.0f) * 4095.0f + 0.5f) << 12u) |
         (uint(clamp(surface.roughness, 0.0f, 1.0f) * 255.0f + 0.5f) << 24u);
}

ALCOVE_INLINE LobeSurface unpack_lobe_surface(uint bits) {
  LobeSurface surface;
  surface.normal = octahedral_decode(vec2(float(bits & 4095u), float((bits >> 12u) & 4095u)) *
                                         (2.0f / 4095.0f) -
                                     1.0f);
  surface.roughness = float(bits >> 24u) * (1.0f / 255.0f);
  return surface;
}

// What a neighbour's lobe weighs beside a surface's own, [0,1]: it falls to a half where normals
// part by some 12 degrees, or roughness by a tenth.
ALCOVE_INLINE float lobe_weight(LobeSurface own, LobeSurface neighbour) {
  float agreement = max(dot(own.normal, neighbour.normal), 0.0f);
  float squared = agreement * agreement;
  float fourth = squared * squared;
  float eighth = fourth * fourth;
  float sixteenth = eighth * eighth;
  float apart = 10.0f * (own.roughness - neighbour.roughness);
  return sixteenth * sixteenth / (1.0f + apart * apart);
}

ALCOVE_MATHS_END

#endif
