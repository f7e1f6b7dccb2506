// Calls functions of shaders/maths whose results depend on how a language treats bits, rounding and
// integers. GLSL and C++ include this file.
#ifndef ALCOVE_TESTS_PARITY_CASE_H
#define ALCOVE_TESTS_PARITY_CASE_H

#include "maths/half_texel.h"
#include "maths/history.h"
#include "maths/octahedral.h"
#include "maths/packing.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "maths/sampling.h"
#include "maths/visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

ALCOVE_INLINE vec4 parity_case(uvec2 texel) {
  // A point of [0,1)^4 of Roberts's R4 sequence.
  uint index = texel.y * 256u + texel.x;
  vec4 a =
      vec4((index * uvec4(3679390609u, 3152041523u, 2700274805u, 2313257605u)) >> 8u) / 16777216.0f;
  vec3 normal = octahedral_decode(vec2(a.x * 2.0f - 1.0f, a.y * 2.0f - 1.0f));
  uvec2 pixel = uvec2(uint(a.x * 3840.0f), uint(a.y * 2160.0f));
  SliceNoise pattern = golden_pattern(pixel, uint(a.z * 1e4f), a.w < 0.5f);
  RawOcclusion lobe;
  lobe.visible = a.x * a.y;
  lobe.open = a.x;
  switch (index % 4u) {
    case 0u:
      return vec4(pattern.direction, pattern.offset, float(pack_unorm(a.x, 12u)),
                  float(bitCount(sectors_beyond(biased_position(a.z, a.y)))));
    case 1u:
      lobe = unpack_lobe(pack_lobe(lobe));
      return vec4(lobe.visible, lobe.open, unpack_unorm(uint(a.z * 4095.0f), 12u),
                  unpack_open(uint(a.w * 1000.0f)));
    case 2u:
      return vec4(octahedral_encode(normal), texel_codes(a.z), weight_of_code(a.w * 31.0f));
  }
  return vec4(normal, squared_angle(normal, stereographic_of_bits(uint(a.z * 255.0f))));
}

ALCOVE_MATHS_END

#endif
