// Calls functions of shaders/maths in the same way from GLSL and C++, so that the results of the
// GPU can be compared with those of the CPU. The file is written in the common subset of GLSL and
// C++.
#ifndef ALCOVE_TESTS_PARITY_CASES_H
#define ALCOVE_TESTS_PARITY_CASES_H

#include "maths/bent_normal.h"
#include "maths/connected_samples.h"
#include "maths/ggx.h"
#include "maths/gtao.h"
#include "maths/gtso.h"
#include "maths/history.h"
#include "maths/lobe_slice.h"
#include "maths/multi_bounce.h"
#include "maths/octahedral.h"
#include "maths/packing.h"
#include "maths/projection.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "maths/sampling.h"
#include "maths/unobserved.h"
#include "maths/visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

ALCOVE_INLINE vec3 parity_direction(float x, float y) {
  return octahedral_decode(vec2(x * 2.0f - 1.0f, y * 2.0f - 1.0f));
}

// Returns a unit vector that points towards the eye.
ALCOVE_INLINE vec3 parity_view(float x, float y) {
  vec3 v = parity_direction(x, y);
  return vec3(v.x, v.y, abs(v.z));
}

ALCOVE_INLINE Slice parity_slice(vec4 a) {
  vec3 view = parity_view(a.x, a.y);
  vec3 normal = facing_normal(parity_direction(a.z, a.w), view);
  return make_slice(normal, slice_direction(make_view_basis(view), a.z * kPi), view);
}

// Returns a pseudo-random word (PCG-RXS-M-XS, O'Neill 2014).
ALCOVE_INLINE uint parity_word(uint seed) {
  uint state = seed * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

ALCOVE_INLINE uvec2 parity_pixel(vec4 a) { return uvec2(uint(a.x * 960.0f), uint(a.y * 540.0f)); }

ALCOVE_INLINE vec4 parity_of_slices(uint which, vec4 a, vec4 b) {
  Slice s = parity_slice(a);
  float ahead = b.x * 2.0f - 1.0f;
  float behind = b.y * 2.0f - 1.0f;
  switch (which) {
    case 0u:
      // The angle is multiplied by the length of the projected normal, because it is
      // ill-conditioned if the normal is perpendicular to the slice.
      return vec4(s.along, s.toward, s.scale, slice_gamma(s) * s.scale);
    case 1u:
      return vec4(slice_arc(s, 1.0f, ahead), slice_arc(s, -1.0f, behind),
                  slice_visibility(s, ahead, behind), open_slice(s));
    case 2u: {
      vec3 view = parity_view(a.x, a.y);
      vec3 direction = slice_direction(make_view_basis(view), a.z * kPi);
      vec3 bent = slice_bent_normal(s, direction, view, ahead, behind);
      vec3 residual = residual_of(bent, slice_visibility(s, ahead, behind), view);
      return vec4(residual.x, residual.y, residual.z, 0.0f);
    }
    case 3u: {
      vec2 point = vec2(b.z, ahead);
      return vec4(diamond_angle(point), diamond_angle_light(2.0f * b.w).x,
                  tangent_diamond_angle(s, 1.0f), height_of_back(ahead, b.z, b.w));
    }
    case 4u:
      return vec4(arc_cosine(ahead), arc_cosine(behind),
                  update_recent(b.x, floor(b.y * 40.0f), b.z, b.w), 0.0f);
  }
  return vec4(0.0f);
}

ALCOVE_INLINE vec4 parity_of_cameras(uint which, vec4 a, vec4 b, Projection p) {
  vec2 uv = vec2(a.x, a.y);
  float depth = 0.2f + a.z * 50.0f;
  vec3 position = position_vs(p, uv, depth);
  vec3 view = view_direction(p, position);
  switch (which) {
    case 5u:
      return vec4(position.x, position.y, position.z, linear_depth(p, b.x));
    case 6u:
      return vec4(
          history_agreement(vec4(history_depth(vec2(0.05f, 0.5f), log2(depth)) - b.w), 0.001f).x,
          visibility_changed(b.x, b.y), view.x, view.z);
  }
  return vec4(0.0f);
}

ALCOVE_INLINE vec4 parity_of_light(uint which, vec4 a, vec4 b) {
  vec3 normal = vec3(0.0f, 0.0f, 1.0f);
  vec3 view = parity_view(a.x, a.y);
  vec3 light = parity_view(a.z, a.w);
  float alpha = 0.05f + 0.95f * b.x;
  switch (which) {
    case 7u: {
      vec3 h = sample_ggx_normal(view, alpha, b.y, b.z);
      return vec4(h.x, h.y, h.z, ggx_shadowing(view.z, light.z, alpha));
    }
    case 8u:
      return vec4(ggx_reflection_density(normal, view, light, alpha), ggx_masking(view.z, alpha),
                  ggx_distribution(light.z, alpha), 0.0f);
    case 9u:
      return vec4(visibility_cone(b.w), angle_between(view, light), 0.0f, 0.0f);
    case 10u:
      return vec4(multi_bounce_channel(b.y, b.z), 0.0f, 0.0f, 0.0f);
  }
  return vec4(0.0f);
}

ALCOVE_INLINE vec4 parity_of_storage(uint which, vec4 a, vec4 b) {
  switch (which) {
    case 11u: {
      vec2 encoded = octahedral_encode(parity_direction(a.x, a.y));
      vec3 decoded = octahedral_decode(encoded);
      return vec4(encoded.x, encoded.y, decoded.x, decoded.z);
    }
    case 12u: {
      uint word = pack_unorm(a.x, 12u);
      return vec4(unpack_unorm(word, 12u), unpack_unorm(pack_unorm(a.y, 8u), 8u),
                  squared_angle(vec3(0.0f, 0.6f, 1.8f), stereographic_of_bits(uint(a.z * 255.0f))),
                  unpack_open(uint(a.w * 1000.0f)));
    }
    case 13u:
      return vec4(weight_of_code(b.z * 31.0f), recent_of_code(texel_recent_code(b.x), b.z),
                  texel_codes(b.y), 0.0f);
    case 14u:
      return vec4(weight_after_blur(b.z * 40.0f, b.y * 0.25f, b.x), 0.0f, 0.0f, 0.0f);
    case 21u: {
      RawOcclusion lobe;
      lobe.visible = a.x * a.y;
      lobe.open = a.x;
      lobe = unpack_lobe(pack_lobe(lobe));
      // The surface is made from whole bytes, so that packing is exact. A difference of one byte
      // would change the weight by a quarter.
      uvec3 bytes = uvec3(uint(b.x * 255.0f), uint(b.y * 255.0f), uint(b.z * 255.0f));
      LobeSurface surface;
      surface.normal = normalize(vec3(bytes) * (2.0f / 255.0f) - vec3(1.0f));
      surface.roughness = a.w;
      uint word = bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (uint(a.w * 255.0f) << 24u);
      return vec4(lobe.visible, lobe.open, lobe_weight(surface, word),
                  lobe_angle(a.z * kPi, a.w, b.w).phi);
    }
  }
  return vec4(0.0f);
}

ALCOVE_INLINE vec4 parity_of_sampling(uint which, vec4 a, vec4 b) {
  uvec2 pixel = parity_pixel(a);
  uint frame = uint(a.z * 1000.0f);
  switch (which) {
    case 15u:
      return vec4(golden_pattern(pixel, frame, true).direction,
                  golden_pattern(pixel, frame, true).offset,
                  golden_pattern(pixel, frame, false).direction,
                  golden_pattern(pixel, frame, false).offset);
    case 20u:
      return vec4(hidden_occlusion_behind(b.x, b.y * b.z, b.z, hidden_exponent(b.w)),
                  hidden_exponent(b.w), 0.0f, 0.0f);
    case 16u:
      return vec4(visible_share_beyond(parity_word(pixel.x)), 0.0f, 0.0f, 0.0f);
    case 17u:
      return vec4(slice_angle(1u, 3u, b.w), 0.0f, 0.0f, 0.0f);
    case 18u: {
      Slice s = parity_slice(a);
      VisiblePart part =
          visible_part(s, -1.0f, 32.0f / tangent_diamond_angle(s, -1.0f), parity_word(pixel.x),
                       hidden_occlusion_behind(b.y, 0.0f, 1.0f, hidden_exponent(b.x)), true);
      return vec4(part.arc, part.bent.x, part.bent.y, 0.0f);
    }
    case 19u: {
      Slice s = parity_slice(a);
      HalfLobe front = make_half_lobe(s, 1.0f, 0.05f + 0.95f * b.x);
      HalfLobe rear = make_half_lobe(s, -1.0f, 0.05f + 0.95f * b.x);
      float ahead = b.y * 2.0f - 1.0f;
      float behind = b.z * 2.0f - 1.0f;
      return vec4(
          front.whole + rear.whole, lobe_arc(s, front, ahead) + lobe_arc(s, rear, behind),
          visible_lobe(front, 32.0f / tangent_diamond_angle(s, 1.0f), parity_word(pixel.x), 0.4f),
          visible_lobe(rear, 32.0f / tangent_diamond_angle(s, -1.0f), parity_word(pixel.y), 0.0f));
    }
    case 22u: {
      Slice s = parity_slice(a);
      HalfLobe lobe = make_half_lobe(s, 1.0f, 0.05f + 0.95f * b.x);
      Unobserved unobserved = nothing_unobserved();
      unobserved.first = b.y;
      unobserved.width = b.z;
      unobserved.rows = 2.0f;
      unobserved = add_beyond_border(mean_row(unobserved), b.w, b.z, border_share(b.x, b.y));
      // No sector is occluded in this case, because rounding could otherwise move an end of the arc
      // by a whole sector.
      UnobservedArc arc = make_unobserved_arc(tangent_light(s, 1.0f), unobserved, 1.0f);
      return vec4(unobserved_part(arc, s, 1.0f, light_arc(s, 1.0f, arc.to)),
                  unobserved_lobe(arc, lobe, lobe_light_arc(lobe, arc.to)), arc.share, 0.0f);
    }
  }
  return vec4(0.0f);
}

const uint kParityCases = 23u;

// Returns four results of case `which` for eight numbers in [0,1).
ALCOVE_INLINE vec4 parity_case(uint which, vec4 a, vec4 b, Projection p) {
  if (which < 5u) return parity_of_slices(which, a, b);
  if (which < 7u) return parity_of_cameras(which, a, b, p);
  if (which < 11u) return parity_of_light(which, a, b);
  if (which < 15u || which == 21u) return parity_of_storage(which, a, b);
  return parity_of_sampling(which, a, b);
}

ALCOVE_MATHS_END

#endif
