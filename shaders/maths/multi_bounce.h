// Multi-bounce: the light that occluders reflect ([Jimenez 2016], section 5).
//
// An occluder with the albedo and the lighting of the surface reflects a part of the light that it
// receives. The paper fits the result, per channel, with a cubic polynomial of the visibility.
#ifndef ALCOVE_MATHS_MULTI_BOUNCE_H
#define ALCOVE_MATHS_MULTI_BOUNCE_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns visibility raised by interreflection, for one channel. `visibility` and `albedo` are
// clamped to [0,1]. The result is at least the visibility and at most 1, and grows with both
// arguments. Both bounds are enforced, because the polynomial alone gives 0.9996 to 1.0001 at
// visibility 1.
ALCOVE_INLINE float multi_bounce_channel(float visibility, float albedo) {
  float v = saturate(visibility);
  float p = saturate(albedo);
  float a = 2.0404f * p - 0.3324f;
  float b = -4.7951f * p + 0.6417f;
  float c = 2.7552f * p + 0.6903f;
  return min(max(v, ((v * a + b) * v + c) * v), 1.0f);
}

// Returns multi_bounce_channel() for the three channels of a colour.
ALCOVE_INLINE vec3 multi_bounce(float visibility, vec3 albedo) {
  return vec3(multi_bounce_channel(visibility, albedo.x),
              multi_bounce_channel(visibility, albedo.y),
              multi_bounce_channel(visibility, albedo.z));
}

ALCOVE_MATHS_END

#endif
