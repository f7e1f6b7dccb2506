// The position of a surface in the previous frame, and the values of the history there.
#ifndef ALCOVE_RECONSTRUCT_PREVIOUS_H
#define ALCOVE_RECONSTRUCT_PREVIOUS_H

#include "reconstruct_surface.h"

// The values of a surface in the history.
struct History {
  float weight;     // frames; 0 where nothing of this surface is known
  float occlusion;  // [0,1]
  float recent;     // occlusion of the last few frames, [0,1]
  vec3 residual;    // of the bent normal, for a weight of 1
  vec2 lobe;        // occluded, open, for a weight of 1
  float between;    // distance from texel centres: 0 at one, 0.5 amid four
};

History no_history() { return History(0.0, 0.0, 0.0, vec3(0.0), vec2(0.0), 0.0); }

// Largest change of depth since the previous frame, relative to the depth, at which a moving
// surface keeps its history.
const float kDepthMotion = 0.04;

// The largest distance, in the units of HistoryTexels::distances, at which a texel of a static
// image keeps its history. It is the distance at which the weight of a texel in a moving image, (1
// - distance)^2, is 0.05.
const float kSameTexel = 0.776;

// The position of a surface in the image of the previous frame.
struct Previous {
  vec2 position;  // texels from the centre of the first one, clamped to that of the last one
  float depth;    // in perspective over the depth now, and positive; in orthographic views linear
  bool seen;      // it was on the image
  bool moves;     // the surface moved, not only the camera
};

Previous reproject(Surface surface) {
  vec4 to = surface.place.previous + surface.inverse_depth * parameters.previous_from_pixel[3];
  vec2 position = to.xy * (1.0 / max(to.z, 1e-20));
  Previous previous;
  previous.depth = kPerspective ? max(to.w, 1e-30) : to.w;
  previous.moves = false;
  if (kMotion) {
    vec2 motion = texelFetch(motion_image, in_inputs(surface.pixel), 0).rg * parameters.motion.xy;
    vec2 moved =
        surface.place.centre * parameters.previous_extent.zw - parameters.motion.zw - motion;
    // More than the rounding of motion vectors, which is 2^-11 in half precision: four times that,
    // and a tenth of a pixel (both chosen).
    previous.moves = any(
        greaterThan(abs(moved - position), abs(motion) * (1.0 / 512.0) + 0.1 / float(kTexelSize)));
    // A NaN would stay in the history.
    position = moved == moved ? moved : vec2(-1e6);
  }
  vec2 first = vec2(first_written() / kTexelSize);
  previous.position = clamp(position, first, parameters.previous_extent.xy);
  vec2 outside = abs(position - previous.position);
  previous.seen = to.z > 0.0 && max(outside.x, outside.y) <= 0.5;
  return previous;
}

// Returns the bilinear weights of four texels in the order of textureGather.
vec4 bilinear_weights(vec2 part) {
  vec2 rest = 1.0 - part;
  return vec4(rest.x * part.y, part.x * part.y, part.x * rest.y, rest.x * rest.y);
}

// Returns `first` plus the change from the position to each of the four texels, in the order of
// textureGather. `gradient` is the change per texel.
vec4 gather_offsets(vec2 gradient, vec2 part, float first) {
  float left = first - part.x * gradient.x - part.y * gradient.y;
  float right = left + gradient.x;
  return vec4(left + gradient.y, right + gradient.y, right, left);
}

float sum_of(vec4 v) { return v.x + v.y + v.z + v.w; }

// Returns the differences of depth of four texels from the expected depth of a moving surface,
// minus the smallest of them if that is at most `limit`. Motion vectors do not tell how far a
// surface has moved towards the eye; the texel that is nearest to the expected depth does.
vec4 follow_depth(vec4 differences, float limit) {
  vec4 apart = abs(differences);
  float least = min(min(apart.x, apart.y), min(apart.z, apart.w));
  if (least > limit) return differences;
  float shift = apart.x == least   ? differences.x
                : apart.y == least ? differences.y
                : apart.z == least ? differences.z
                                   : differences.w;
  return differences - shift;
}

// The values of the history at the four texels around a position, in the order of textureGather.
struct HistoryTexels {
  // From the surface's tangent plane, in units at which a texel of another depth no longer counts.
  vec4 distances;
  vec4 occlusions;
  vec4 weights;  // for mean_weight()
  vec4 recents;  // for recent_of_mean(); only with kMotion
};

#endif
