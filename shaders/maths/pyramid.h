// One level of the depth pyramid from the one above: four linear depths become one.
//
// A plain mean invents surfaces that float between an edge's two sides, and they occlude both.
#ifndef ALCOVE_MATHS_PYRAMID_H
#define ALCOVE_MATHS_PYRAMID_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// The sky as the nearest depth of all, so that a maximum passes it over.
ALCOVE_INLINE float sky_to_nearest(float depth) { return depth < kSkyDepth ? depth : -kSkyDepth; }

// Weight of `depth` in a mean that keeps to within `reach` of the farthest surface.
ALCOVE_INLINE float pyramid_weight(float depth, float farthest, float reach) {
  if (!(depth < kSkyDepth)) return 0.0f;
  return clamp(2.0f - 2.0f * (farthest - depth) / reach, 0.0f, 1.0f);
}

// Depth relative to the farthest, so that a large one loses no digits; 0 for the sky.
ALCOVE_INLINE float pyramid_step(float depth, float farthest) {
  return depth < kSkyDepth ? depth - farthest : 0.0f;
}

// The mean of those of four linear depths that lie within `reach` (a length, positive: twice how
// deep one surface may run across four texels) of the farthest that is not sky: a plain mean within
// half of `reach`, so that slopes keep their depth, fading to nothing at all of it. It leans to the
// far side because a near side that is lost costs a little occlusion, and a far side that is lost
// darkens everything behind the edge. kSkyDepth where three of the four are sky.
ALCOVE_INLINE float average_depth(vec4 depths, float reach) {
  float sky = (depths.x < kSkyDepth ? 0.0f : 1.0f) + (depths.y < kSkyDepth ? 0.0f : 1.0f) +
              (depths.z < kSkyDepth ? 0.0f : 1.0f) + (depths.w < kSkyDepth ? 0.0f : 1.0f);
  if (sky > 2.5f) return kSkyDepth;
  float farthest = max(max(sky_to_nearest(depths.x), sky_to_nearest(depths.y)),
                       max(sky_to_nearest(depths.z), sky_to_nearest(depths.w)));
  vec4 weights =
      vec4(pyramid_weight(depths.x, farthest, reach), pyramid_weight(depths.y, farthest, reach),
           pyramid_weight(depths.z, farthest, reach), pyramid_weight(depths.w, farthest, reach));
  vec4 steps = vec4(pyramid_step(depths.x, farthest), pyramid_step(depths.y, farthest),
                    pyramid_step(depths.z, farthest), pyramid_step(depths.w, farthest));
  float weight_sum = weights.x + weights.y + weights.z + weights.w;
  return farthest + dot(weights, steps) / weight_sum;
}

ALCOVE_MATHS_END

#endif
