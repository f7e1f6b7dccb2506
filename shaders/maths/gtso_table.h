// Specular occlusion from a table ([Jimenez 2016], section 6). The table has the visible fraction
// of the GGX lobe itself, which the cones of gtso.h only approximate.
//
// The table has four parameters: the half-angle of the visibility cone, the angle between its axis
// (the bent normal) and the mirror direction, the angle between the mirror direction and the
// normal, and the roughness. These do not determine the azimuth of the bent normal around the
// mirror direction. An entry is therefore the mean over evenly spaced azimuths at which the whole
// cone lies above the surface. If there is no such azimuth, it is the value for the bent normal
// that is turned towards the normal. Fractions are relative to the part of the lobe above the
// surface.
//
// When the mirror direction leaves the cone, the fraction falls from 1 to 0 within the width of the
// lobe. The table's first coordinate is therefore the angle by which the mirror direction is inside
// the cone, divided by the width of the lobe and compressed, so that the whole range fits and most
// entries are near 0.
#ifndef ALCOVE_MATHS_GTSO_TABLE_H
#define ALCOVE_MATHS_GTSO_TABLE_H

#include "constants.h"
#include "ggx.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// Number of entries along each coordinate: angle inside the cone, half-angle of the cone, angle of
// the mirror direction, roughness. The table has 54 KiB with 8 bits per entry. Interpolated between
// entries, its RMS error is .006 and its largest error .29, for a narrow lobe at the edge of the
// cone (`maths_test --gtest_filter='GtsoTable*'`). With 24 12 12 12 entries these would be .007 and
// .33, with 32 16 16 16 entries .005 and .28. The error of 8 bits alone is at most .002.
const uint kGtsoInside = 24u;
const uint kGtsoCone = 12u;
const uint kGtsoMirror = 16u;
const uint kGtsoRoughness = 12u;
const uint kGtsoEntries = kGtsoInside * kGtsoCone * kGtsoMirror * kGtsoRoughness;

// Returns the width of the lobe, in radians, that the table's coordinates use.
ALCOVE_INLINE float gtso_width(float roughness) {
  return 2.5f * max(roughness * roughness, kSmallestAlpha);
}

// Maps the angle by which a direction is inside a cone, [cone - pi, cone], to [-1,1]. The rim of
// the cone is mapped to 0.
ALCOVE_INLINE float squeeze_inside(float inside, float cone, float width) {
  float most = inside < 0.0f ? kPi - cone : cone;
  float size = min(abs(inside), most);
  float squeezed = size / (size + width) * (most + width) / max(most, 1e-6f);
  return inside < 0.0f ? -squeezed : squeezed;
}

ALCOVE_INLINE float unsqueeze_inside(float squeezed, float cone, float width) {
  float most = squeezed < 0.0f ? kPi - cone : cone;
  float part = abs(squeezed) * most / (most + width);
  float size = min(part * width / max(1.0f - part, 1e-6f), most);
  return squeezed < 0.0f ? -size : size;
}

// Maps the half-angle of a cone, [0,pi/2], to [0,1]. Cones narrower than the lobe get as many
// entries as wider ones.
ALCOVE_INLINE float squeeze_cone(float cone, float width) {
  return cone / (cone + width) * (kHalfPi + width) / kHalfPi;
}

ALCOVE_INLINE float unsqueeze_cone(float squeezed, float width) {
  float part = squeezed * kHalfPi / (kHalfPi + width);
  return min(part * width / max(1.0f - part, 1e-6f), kHalfPi);
}

// squeeze_mirror() maps the angle between the mirror direction and the normal, [0,pi/2], to [0,1],
// with most entries at grazing angles. unsqueeze_mirror() is its inverse.
ALCOVE_INLINE float squeeze_mirror(float mirror_from_normal) {
  float part = clamp(mirror_from_normal / kHalfPi, 0.0f, 1.0f);
  return part * part;
}

ALCOVE_INLINE float unsqueeze_mirror(float squeezed) { return sqrt(squeezed) * kHalfPi; }

// Returns the table coordinates of a configuration, each from 0 to the number of entries minus 1.
// Angles are in radians: `cone` in [0,pi/2], `bent_from_mirror` in [0,pi], `mirror_from_normal` in
// [0,pi/2]. Values out of range are clamped.
ALCOVE_INLINE vec4 gtso_coordinates(float cone, float bent_from_mirror, float mirror_from_normal,
                                    float roughness) {
  float half_angle = clamp(cone, 0.0f, kHalfPi);
  float width = gtso_width(roughness);
  float inside = squeeze_inside(half_angle - bent_from_mirror, half_angle, width);
  return vec4((inside * 0.5f + 0.5f) * float(kGtsoInside - 1u),
              squeeze_cone(half_angle, width) * float(kGtsoCone - 1u),
              squeeze_mirror(mirror_from_normal) * float(kGtsoMirror - 1u),
              clamp(roughness, 0.0f, 1.0f) * float(kGtsoRoughness - 1u));
}

ALCOVE_INLINE uint gtso_index(uvec4 entry) {
  return ((entry.w * kGtsoMirror + entry.z) * kGtsoCone + entry.y) * kGtsoInside + entry.x;
}

// Returns the largest azimuth, [0,pi], of the bent normal around the mirror direction at which the
// whole cone lies above the surface. Azimuth 0 points towards the normal.
ALCOVE_INLINE float gtso_sides(float cone, float bent_from_mirror, float mirror_from_normal) {
  float level = cos(bent_from_mirror) * cos(mirror_from_normal);
  float steep = sin(bent_from_mirror) * sin(mirror_from_normal);
  if (steep < 1e-6f) return kPi;
  return acos(clamp((sin(cone) - level) / steep, -1.0f, 1.0f));
}

// Returns the index of the entry below the coordinates along each axis. It is never the last index
// of an axis, so that an entry above it exists too.
ALCOVE_INLINE uvec4 gtso_entry(vec4 coordinates) {
  return uvec4(min(uint(coordinates.x), kGtsoInside - 2u), min(uint(coordinates.y), kGtsoCone - 2u),
               min(uint(coordinates.z), kGtsoMirror - 2u),
               min(uint(coordinates.w), kGtsoRoughness - 2u));
}

// gtso_corner() returns the entry at corner `corner` (0 to 15) of the cell between entries: bit i
// selects the upper entry along axis i. gtso_corner_weight() returns its interpolation weight at
// the position `t` in the cell, [0,1]^4.
ALCOVE_INLINE uvec4 gtso_corner(uvec4 entry, uint corner) {
  return uvec4(entry.x + (corner & 1u), entry.y + ((corner >> 1u) & 1u),
               entry.z + ((corner >> 2u) & 1u), entry.w + ((corner >> 3u) & 1u));
}

ALCOVE_INLINE float gtso_corner_weight(vec4 t, uint corner) {
  return ((corner & 1u) != 0u ? t.x : 1.0f - t.x) * ((corner & 2u) != 0u ? t.y : 1.0f - t.y) *
         ((corner & 4u) != 0u ? t.z : 1.0f - t.z) * ((corner & 8u) != 0u ? t.w : 1.0f - t.w);
}

// Returns the specular visibility in the cases that need no table: nothing or everything is
// visible, or the surface is a mirror. In all other cases returns a negative value.
ALCOVE_INLINE float gtso_exact(float visibility, float cone, float bent_from_mirror,
                               float roughness) {
  if (visibility <= 0.0f) return 0.0f;
  if (visibility >= 1.0f) return 1.0f;
  if (roughness * roughness <= kSmallestAlpha) return bent_from_mirror <= cone ? 1.0f : 0.0f;
  return -1.0f;
}

ALCOVE_MATHS_END

#endif
