// The light that returns from the occluders (Jimenez et al. 2016, section 5).
//
// An occluder of the same albedo as the surface, lit as the surface is, sends back part of what it
// takes. The paper fits the result, per channel, as a cubic of the visibility.
#ifndef ALCOVE_MATHS_MULTI_BOUNCE_H
#define ALCOVE_MATHS_MULTI_BOUNCE_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Visibility brightened by interreflection, one channel. `visibility` and `albedo` in [0,1]
// (saturated); the result is at least the visibility and at most 1, and grows with both. The cubic
// alone gives 0.9996 to 1.0001 at visibility 1, hence both bounds.
ALCOVE_INLINE float multi_bounce_channel(float visibility, float albedo) {
  float v = saturate(visibility);
  float p = saturate(albedo);
  float a = 2.0404f * p - 0.3324f;
  float b = -4.7951f * p + 0.6417f;
  float c = 2.7552f * p + 0.6903f;
  return min(max(v, ((v * a + b) * v + c) * v), 1.0f);
}

// multi_bounce_channel() of the three channels of a colour.
ALCOVE_INLINE vec3 multi_bounce(float visibility, vec3 albedo) {
  return vec3(multi_bounce_channel(visibility, albedo.x),
              multi_bounce_channel(visibility, albedo.y),
              multi_bounce_channel(visibility, albedo.z));
}

ALCOVE_MATHS_END

#endif
