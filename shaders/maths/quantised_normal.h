// A normal that faces the eye, quantised to one byte. That is precise enough to distinguish the two
// surfaces at a crease.
//
// It is stored by its stereographic coordinates in view space: a vector of length tan(angle / 2),
// where `angle` is the angle between the normal and the view axis. Stereographic projection is
// conformal, so that small distances between coordinates are proportional to angles without
// decoding.
#ifndef ALCOVE_MATHS_QUANTISED_NORMAL_H
#define ALCOVE_MATHS_QUANTISED_NORMAL_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns the stereographic coordinates that the lowest eight bits of `bits` encode.
ALCOVE_INLINE vec2 stereographic_of_bits(uint bits) {
  return vec2((float(bits & 15u) - 7.0f) * (1.0f / 7.0f),
              (float((bits >> 4u) & 15u) - 7.0f) * (1.0f / 7.0f));
}

// Quantises a unit normal in view space to 8 bits. Stereographic coordinates are clamped to those
// of directions 90 degrees from the view axis. Each coordinate has 15 values, so the error is at
// most 12 degrees.
ALCOVE_INLINE uint quantise_normal(vec3 normal) {
  vec2 stereographic = vec2(normal.x, normal.y) * (1.0f / max(1.0f + normal.z, 0.1f));
  return uint(clamp(stereographic.x, -1.0f, 1.0f) * 7.0f + 7.5f) |
         (uint(clamp(stereographic.y, -1.0f, 1.0f) * 7.0f + 7.5f) << 4u);
}

// Returns the approximate squared angle, in radians squared, between the normal (x, y, z) and one
// with the stereographic coordinates `other`. `own` is (x, y, 1 + z). The result is 0 for equal
// normals, grows with the angle, and is above 0.5 for angles of 60 degrees or more.
ALCOVE_INLINE float squared_angle(vec3 own, vec2 other) {
  vec2 apart = other * own.z - vec2(own.x, own.y);
  return dot(apart, apart);
}

ALCOVE_MATHS_END

#endif
