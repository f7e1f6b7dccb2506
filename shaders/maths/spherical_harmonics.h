// Irradiance from nine spherical-harmonics coefficients of the light around a point (Ramamoorthi
// and Hanrahan 2001).
//
// The basis is real and orthonormal, of order 2, in the sequence (0,0); (1,-1), (1,0), (1,1);
// (2,-2), (2,-1), (2,0), (2,1), (2,2), without the Condon-Shortley phase: element 1 is along +y, 2
// along +z, 3 along +x. Coefficients are of radiance, not yet of irradiance.
#ifndef ALCOVE_MATHS_SPHERICAL_HARMONICS_H
#define ALCOVE_MATHS_SPHERICAL_HARMONICS_H

#include "language.h"

ALCOVE_MATHS_BEGIN

const uint kHarmonics = 9u;

// Returns the basis function `index` (below kHarmonics) at a unit direction.
ALCOVE_INLINE float harmonic(uint index, vec3 d) {
  switch (index) {
    case 0u:
      return 0.282094792f;
    case 1u:
      return 0.488602512f * d.y;
    case 2u:
      return 0.488602512f * d.z;
    case 3u:
      return 0.488602512f * d.x;
    case 4u:
      return 1.092548431f * d.x * d.y;
    case 5u:
      return 1.092548431f * d.y * d.z;
    case 6u:
      return 0.315391565f * (3.0f * d.z * d.z - 1.0f);
    case 7u:
      return 1.092548431f * d.x * d.z;
  }
  return 0.546274215f * (d.x * d.x - d.y * d.y);
}

// Returns the factor that converts a coefficient of radiance to a coefficient of irradiance divided
// by pi: 1, 2/3 or 1/4 for bands 0, 1 and 2.
ALCOVE_INLINE float harmonic_irradiance(uint index) {
  return index == 0u ? 1.0f : (index < 4u ? 2.0f / 3.0f : 0.25f);
}

ALCOVE_MATHS_END

#endif
