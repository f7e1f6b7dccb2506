// The two numbers that a search leaves at a pixel, and its normal, in 4 bytes; its depth takes 4
// more.
//
// Filters and history add up visible parts and open parts and divide last. What is stored is their
// ratio, so that an open surface stays open to the last bit, and the open part.
#ifndef ALCOVE_MATHS_RAW_OCCLUSION_H
#define ALCOVE_MATHS_RAW_OCCLUSION_H

#include "packing.h"

ALCOVE_MATHS_BEGIN

struct RawOcclusion {
  float visible;  // visible part of the slices, [0,open]
  float open;     // all of them, [0,kLargestOpen]
};

// Of a mean over slices, and of one weighted by a filter's window.
const float kLargestOpen = 4.0f;

// Sum of visible parts over sum of open ones, in [0,1]. Nothing weighed means nothing known: open.
ALCOVE_INLINE float mean_visibility(RawOcclusion sum) {
  return sum.open > 0.0f ? saturate(sum.visible / sum.open) : 1.0f;
}

// The open part in 11 bits, within a 120th of itself, as it only weighs: a half without its sign
// and its last four digits. Out of range comes out as the nearest in range.
ALCOVE_INLINE uint pack_open(float open) {
  return (packHalf2x16(vec2(clamp(open, 0.0f, kLargestOpen), 0.0f)) + 8u) >> 4u;
}

ALCOVE_INLINE float unpack_open(uint bits) { return unpackHalf2x16((bits & 0x7ffu) << 4u).x; }

// The ratio to 2^-14, and the searched surface's normal of QuantisedNormal.
ALCOVE_INLINE uint pack_raw_occlusion(RawOcclusion raw_occlusion, uint quantised_normal) {
  return pack_unorm(mean_visibility(raw_occlusion), 13u) | (pack_open(raw_occlusion.open) << 13u) |
         (quantised_normal << 24u);
}

ALCOVE_INLINE RawOcclusion unpack_raw_occlusion(uint bits) {
  RawOcclusion raw_occlusion;
  raw_occlusion.open = unpack_open(bits >> 13u);
  raw_occlusion.visible = unpack_unorm(bits, 13u) * raw_occlusion.open;
  return raw_occlusion;
}

ALCOVE_INLINE uint raw_occlusion_normal(uint bits) { return bits >> 24u; }

// Components of a residual (bent_normal.h) are no larger.
const float kLargestResidual = 4.0f / 3.0f;

// A residual in 10 bits a component, each clamped to kLargestResidual in size and within 0.0014
// after unpack_residual(); 0 comes back as it is.
ALCOVE_INLINE uint pack_residual(vec3 residual) {
  vec3 scaled = clamp(residual * (1.0f / kLargestResidual), -1.0f, 1.0f) * 511.0f + 512.5f;
  return uint(scaled.x) | (uint(scaled.y) << 10u) | (uint(scaled.z) << 20u);
}

ALCOVE_INLINE vec3 unpack_residual(uint bits) {
  vec3 scaled =
      vec3(float(bits & 1023u), float((bits >> 10u) & 1023u), float((bits >> 20u) & 1023u));
  return (scaled - 512.0f) * (kLargestResidual / 511.0f);
}

// The same of a GGX lobe, whose open part differs by orders of magnitude from slice to slice: the
// ratio to 2^-17, the open part, at least 0 and finite, to 2^-8 of itself.
ALCOVE_INLINE uint pack_lobe(RawOcclusion lobe) {
  float ratio = lobe.open > 0.0f ? clamp(lobe.visible / lobe.open, 0.0f, 1.0f) : 1.0f;
  uint open = (floatBitsToUint(lobe.open) + 0x8000u) & 0xffff0000u;
  return uint(ratio * 65535.0f + 0.5f) | open;
}

ALCOVE_INLINE RawOcclusion unpack_lobe(uint bits) {
  RawOcclusion lobe;
  lobe.open = uintBitsToFloat(bits & 0xffff0000u);
  lobe.visible = float(bits & 0xffffu) * (1.0f / 65535.0f) * lobe.open;
  return lobe;
}

// The surface that a lobe belongs to, for filters.
struct LobeSurface {
  vec3 normal;      // unit
  float roughness;  // perceptual, [0,1]
};

// A byte each: normal to half a degree, roughness to 2^-9.
ALCOVE_INLINE uint pack_lobe_surface(LobeSurface surface) {
  return packUnorm4x8(vec4(surface.normal.x * 0.5f + 0.5f, surface.normal.y * 0.5f + 0.5f,
                           surface.normal.z * 0.5f + 0.5f, surface.roughness));
}

ALCOVE_INLINE float sixteenth_power(float x) {
  float squared = x * x;
  float fourth = squared * squared;
  float eighth = fourth * fourth;
  return eighth * eighth;
}

// What the lobe of a neighbour, packed, weighs beside a surface's own, [0,1]: a half where normals
// part by some 12 degrees or roughness by a tenth.
ALCOVE_INLINE float lobe_weight(LobeSurface own, uint neighbour) {
  // dot(own.normal, bytes * 2 / 255 - 1), the scale on the own side, where it is done once.
  vec3 scaled = own.normal * (2.0f / 255.0f);
  float offset = own.normal.x + own.normal.y + own.normal.z;
  float agreement = scaled.x * float(neighbour & 255u) +
                    scaled.y * float((neighbour >> 8u) & 255u) +
                    scaled.z * float((neighbour >> 16u) & 255u) - offset;
  // Bytes round unit vectors to no more than 1.007; longer ones must not outweigh all others.
  float sixteenth = sixteenth_power(clamp(agreement, 0.0f, 1.01f));
  float apart = own.roughness * 5.0f - float(neighbour >> 24u) * (5.0f / 255.0f);
  return sixteenth * sixteenth * max(1.0f - abs(apart), 0.0f);
}

// The visibility that an artist wants of `visibility`: 1 - intensity * (1 - visibility^power), cut
// to [0,1]. Open stays open; a power or an intensity over 1 darkens, one below 1 brightens.
ALCOVE_INLINE float shaped_visibility(float visibility, float power, float intensity) {
  return saturate(1.0f - intensity * (1.0f - pow(max(visibility, 0.0f), power)));
}

ALCOVE_MATHS_END

#endif
