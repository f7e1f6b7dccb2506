// The raw occlusion of a traced pixel: the visible and the unoccluded part of its slices, with its
// normal and its depth. The texel has two words (R32G32_UINT), and two more with a GGX lobe:
//      31                                    0
//   x | normal 8 | open 11 | visibility     13 |  pack_raw_occlusion()
//   y | inverse depth, a float              32 |
//   z | open             16 | visibility    16 |  pack_lobe(), the lobe's
//   w | roughness 8 | z 8 | y 8 | x          8 |  pack_lobe_surface()
//
// Filters and history sum visible parts and unoccluded parts, and divide at the end. Stored are the
// unoccluded part `open` and the ratio of the two, the visibility, so that 1 stays exactly 1.
#ifndef ALCOVE_MATHS_RAW_OCCLUSION_H
#define ALCOVE_MATHS_RAW_OCCLUSION_H

#include "packing.h"

ALCOVE_MATHS_BEGIN

struct RawOcclusion {
  float visible;  // the visible part of the slices, [0,open]
  float open;     // the same integral without occluders, which is the weight, [0,kLargestOpen]
};

// Upper limit of RawOcclusion::open, before and after multiplication by a filter weight.
const float kLargestOpen = 4.0f;

// Returns the ratio of the visible to the unoccluded part, [0,1], or 1 if the unoccluded part is 0.
ALCOVE_INLINE float mean_visibility(RawOcclusion sum) {
  return sum.open > 0.0f ? saturate(sum.visible / sum.open) : 1.0f;
}

// Packs the unoccluded part into 11 bits: a half-precision float without its sign and its last four
// bits. The relative error is at most 1/120, which is enough for a weight. Values out of range are
// clamped.
ALCOVE_INLINE uint pack_open(float open) {
  return (packHalf2x16(vec2(clamp(open, 0.0f, kLargestOpen), 0.0f)) + 8u) >> 4u;
}

ALCOVE_INLINE float unpack_open(uint bits) { return unpackHalf2x16((bits & 0x7ffu) << 4u).x; }

// Packs the raw occlusion and the normal of a traced pixel. The error of the visibility is at most
// 2^-14.
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

// Upper bound of the components of a residual (bent_normal.h).
const float kLargestResidual = 4.0f / 3.0f;

// Packs a residual. Components are clamped to +-kLargestResidual, and the code of 0 is 512. The
// error after unpack_residual() is at most 0.0014, and 0 for a component of 0. From the highest
// bit:
//     | 0 2 | z 10 | y 10 | x 10 |
ALCOVE_INLINE uint pack_residual(vec3 residual) {
  vec3 scaled = clamp(residual * (1.0f / kLargestResidual), -1.0f, 1.0f) * 511.0f + 512.5f;
  return uint(scaled.x) | (uint(scaled.y) << 10u) | (uint(scaled.z) << 20u);
}

ALCOVE_INLINE vec3 unpack_residual(uint bits) {
  vec3 scaled =
      vec3(float(bits & 1023u), float((bits >> 10u) & 1023u), float((bits >> 20u) & 1023u));
  return (scaled - 512.0f) * (kLargestResidual / 511.0f);
}

// Packs the raw occlusion of a GGX lobe. The unoccluded part, which must be finite and at least 0,
// differs by orders of magnitude between slices. It is therefore stored with a relative error of
// 2^-8. The error of the ratio is at most 2^-17.
ALCOVE_INLINE uint pack_lobe(RawOcclusion lobe) {
  uint open = (floatBitsToUint(lobe.open) + 0x8000u) & 0xffff0000u;
  return pack_unorm(mean_visibility(lobe), 16u) | open;
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

// Packs the normal and the roughness of a surface with one byte per component. The error of the
// normal is at most half a degree, and that of the roughness 2^-9.
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

// Returns the weight, [0,1], that the filter gives to a neighbour, whose packed surface is
// `neighbour`. It is 0.5 if the normals differ by about 12 degrees or the roughness by 0.1.
ALCOVE_INLINE float lobe_weight(LobeSurface own, uint neighbour) {
  // Computes dot(own.normal, bytes * 2 / 255 - 1). The scale is applied to the pixel's own normal,
  // so that it is computed once for all neighbours.
  vec3 scaled = own.normal * (2.0f / 255.0f);
  float offset = own.normal.x + own.normal.y + own.normal.z;
  float agreement = scaled.x * float(neighbour & 255u) +
                    scaled.y * float((neighbour >> 8u) & 255u) +
                    scaled.z * float((neighbour >> 16u) & 255u) - offset;
  // Quantised unit vectors have a length of at most 1.007. The clamp keeps longer vectors from
  // getting a weight far above that of all others.
  float sixteenth = sixteenth_power(clamp(agreement, 0.0f, 1.01f));
  float apart = own.roughness * 5.0f - float(neighbour >> 24u) * (5.0f / 255.0f);
  return sixteenth * sixteenth * max(1.0f - abs(apart), 0.0f);
}

// Returns the visibility after the settings `power` and `intensity`: 1 - intensity * (1 -
// visibility^power), clamped to [0,1]. A visibility of 1 stays 1. A power or an intensity above 1
// darkens, one below 1 brightens.
ALCOVE_INLINE float shaped_visibility(float visibility, float power, float intensity) {
  return saturate(1.0f - intensity * (1.0f - pow(max(visibility, 0.0f), power)));
}

ALCOVE_MATHS_END

#endif
