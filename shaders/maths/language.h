// Macros with which a header compiles both as GLSL (460, GL_GOOGLE_include_directive) and as C++20
// with GLM.
//
// In C++ everything is in namespace alcove::maths, and GLM provides the types and functions of
// GLSL. The headers use only what both languages have: `f` on literals, no swizzles, structs that
// are filled field by field and returned. Every function is pure and may be called from any thread.
#ifndef ALCOVE_MATHS_LANGUAGE_H
#define ALCOVE_MATHS_LANGUAGE_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#include <glm/integer.hpp>

#define ALCOVE_INLINE inline
#define ALCOVE_MATHS_BEGIN namespace alcove::maths {
#define ALCOVE_MATHS_END }

namespace alcove::maths {
using namespace glm;
inline uint lowest_bit(uint bits) { return uint(findLSB(bits)); }
inline uint bit_count(uint bits) { return uint(bitCount(bits)); }
}  // namespace alcove::maths
#else
// naga, which translates to WGSL, needs results of the operand's type. It also refuses constants
// that are selected floats, such as `kFlag ? 2.0 : 1.0`; mix(1.0, 2.0, kFlag) is no constant.
uint lowest_bit(uint bits) { return uint(findLSB(int(bits))); }
uint bit_count(uint bits) { return uint(bitCount(int(bits))); }
#define ALCOVE_INLINE
#define ALCOVE_MATHS_BEGIN
#define ALCOVE_MATHS_END
#endif

ALCOVE_MATHS_BEGIN

// Returns x clamped to [0,1], and 0 for NaN, for which the result of clamp() is undefined.
ALCOVE_INLINE float saturate(float x) { return x > 0.0f ? min(x, 1.0f) : 0.0f; }

// Returns whether a vector can be normalised: it is finite and not zero.
ALCOVE_INLINE bool has_direction(vec3 v) {
  float squared = dot(v, v);
  return squared > 1e-12f && squared < 1e12f;
}

ALCOVE_MATHS_END

#endif
