// Decodes normals in the formats of common g-buffers.
#ifndef ALCOVE_MATHS_NORMAL_ENCODING_H
#define ALCOVE_MATHS_NORMAL_ENCODING_H

#include "octahedral.h"

ALCOVE_MATHS_BEGIN

// The encoding if there is no texture of normals.
const uint kNoNormals = 4u;

// Returns the normal that a texel encodes, which may have any length. `encoding` is an
// AlcoveNormalEncoding: 0 is xyz, 1 is xyz packed into [0,1], 2 is the octahedral map in xy, and 3
// is the octahedral map packed into [0,1]. With kNoNormals the result is 0, like that of a texel
// without a valid normal. `encoding` is a constant in shaders, so that the branches and the load of
// a texel that is not used cost nothing.
ALCOVE_INLINE vec3 decode_normal(vec3 texel, uint encoding) {
  if (encoding == kNoNormals) return vec3(0.0f);
  bool packed = encoding == 1u || encoding == 3u;
  vec3 value = packed ? texel * 2.0f - vec3(1.0f) : texel;
  return encoding >= 2u ? octahedral_unfold(vec2(value.x, value.y)) : value;
}

ALCOVE_MATHS_END

#endif
