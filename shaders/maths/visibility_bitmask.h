// Visibility of a slice as 32 sectors, for occluders of finite thickness (after Therrien, Levesque
// and Gilet 2023).
//
// Sectors are not of equal angle: an angle is mapped through the slice's own distribution of the
// cosine-weighted visibility, so that every sector holds exactly 1/32 of the open slice and a count
// of bits is the integral. Sector 0 lies at the tangent plane on the negative side of the slice.
#ifndef ALCOVE_MATHS_VISIBILITY_BITMASK_H
#define ALCOVE_MATHS_VISIBILITY_BITMASK_H

#include "gtao.h"
#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

const uint kSectorCount = 32u;

// What the distribution of one slice needs: computed once, used by every step.
struct SectorScale {
  float open;          // the open slice, as open_slice() but exactly the sum of its two sides
  float inverse_open;  // 1 / open; 0 where the slice holds nothing
  float view;          // the distribution at the view vector itself, [0,1]
};

ALCOVE_INLINE SectorScale make_sector_scale(Slice s) {
  float behind = slice_arc(s, -1.0f, tangent_horizon(s, -1.0f));
  float ahead = slice_arc(s, 1.0f, tangent_horizon(s, 1.0f));
  SectorScale scale;
  scale.open = max(ahead + behind, 0.0f);
  scale.inverse_open = scale.open > 1e-6f ? 1.0f / scale.open : 0.0f;
  scale.view = behind * scale.inverse_open;
  return scale;
}

// The part of the open slice below an angle, [0,1], growing from the negative side's tangent plane
// to the positive side's. The angle is given by its side (1 or -1) and the cosine to the view
// vector; what lies under the tangent plane counts as on it.
ALCOVE_INLINE float sector_position(Slice s, SectorScale scale, float side, float cosine) {
  return clamp(scale.view + side * slice_arc(s, side, cosine) * scale.inverse_open, 0.0f, 1.0f);
}

// The lowest `count` sectors; any count.
ALCOVE_INLINE uint sectors_below(uint count) {
  return count >= 32u ? 0xffffffffu : (1u << count) - 1u;
}

// The sectors between two positions, in either order. An edge falls on the nearest sector boundary
// with `dither` 0.5; with dithers spread over [0,1) the mean number of sectors is 32 |to - from|
// exactly, however thin the range. Not-a-number covers nothing.
ALCOVE_INLINE uint cover_sectors(float from, float to, float dither) {
  if (!(from >= 0.0f && to >= 0.0f)) return 0u;
  uint low = uint(min(min(from, to), 1.0f) * 32.0f + dither);
  uint high = uint(min(max(from, to), 1.0f) * 32.0f + dither);
  return sectors_below(high) & ~sectors_below(low);
}

// Visibility of the slice, weighted as slice_visibility() is: sum it, and divide by the sum of
// `scale.open`. `occluded` has a bit for every covered sector.
ALCOVE_INLINE float bitmask_visibility(SectorScale scale, uint occluded) {
  return scale.open * (1.0f - float(bitCount(occluded)) * (1.0f / 32.0f));
}

// How thick an occluder is taken to be, in the scene's units, at a linear depth `depth` and for a
// search of `radius`: the sum of a constant, a part of the radius and a part of the depth.
struct Thickness {
  float constant;    // scene units, at least 0
  float per_radius;  // at least 0
  float per_depth;   // at least 0
};

ALCOVE_INLINE float occluder_thickness(Thickness t, float radius, float depth) {
  return t.constant + t.per_radius * radius + t.per_depth * max(depth, 0.0f);
}

// The sectors that one sample covers: from the angle of its front, `delta` away from the surface,
// to the angle of the point `thickness` behind it along the ray that sees it (`sample_view` is the
// unit vector from the sample to the eye; with the surface's own view vector both are the same
// slice).
ALCOVE_INLINE uint sample_sectors(Slice s, SectorScale scale, float side, vec3 delta, vec3 view,
                                  vec3 sample_view, float thickness, float dither) {
  float front = horizon_cosine(delta, view);
  float back = horizon_cosine(delta - sample_view * thickness, view);
  return cover_sectors(sector_position(s, scale, side, front),
                       sector_position(s, scale, side, min(back, front)), dither);
}

ALCOVE_MATHS_END

#endif
