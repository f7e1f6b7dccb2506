// Where a surface was on the image of the frame before, and how deep it lay there.
#ifndef ALCOVE_MATHS_REPROJECTION_H
#define ALCOVE_MATHS_REPROJECTION_H

#include "language.h"
#include "projection.h"

ALCOVE_MATHS_BEGIN

struct Reprojected {
  vec2 uv;      // on the previous image; not confined to it
  float depth;  // linear depth expected there
  float valid;  // 1 if the point lay before the previous eye and on its image, else 0
};

ALCOVE_INLINE float inside_image(vec2 uv) {
  return uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f ? 1.0f : 0.0f;
}

// By camera matrices: for surfaces that stand still. `to_previous_view` takes this frame's view
// space to the previous one's (affine).
ALCOVE_INLINE Reprojected reproject_camera(Projection previous, mat4 to_previous_view,
                                           vec3 position) {
  vec4 moved = to_previous_view * vec4(position.x, position.y, position.z, 1.0f);
  Reprojected r;
  r.depth = -moved.z;
  if (!(clip_w(previous, r.depth) > 1e-6f)) {
    r.uv = vec2(-1.0f, -1.0f);
    r.valid = 0.0f;
    return r;
  }
  r.uv = uv_of_position(previous, vec3(moved.x, moved.y, moved.z));
  r.valid = inside_image(r.uv);
  return r;
}

// By a motion vector, `motion_uv` = this frame's uv minus the previous one's: for whatever moves.
// The depth is that of the same surface moved with the camera alone, the best that is known.
ALCOVE_INLINE Reprojected reproject_motion(Projection previous, mat4 to_previous_view,
                                           vec3 position, vec2 uv, vec2 motion_uv) {
  Reprojected r = reproject_camera(previous, to_previous_view, position);
  r.uv = vec2(uv.x - motion_uv.x, uv.y - motion_uv.y);
  r.valid = inside_image(r.uv);
  return r;
}

// How far from the expected depth a texel of history may lie and still be the same surface, [0,1]:
// 1 at the expected depth, 0 from `tolerance` times it on. `slant` is the cosine between normal and
// view vector: a surface seen edge-on runs deep within one texel.
ALCOVE_INLINE float history_weight(float expected, float found, float tolerance, float slant) {
  float reach = tolerance * max(abs(expected), 1e-6f) / max(slant, 0.1f);
  return clamp(1.0f - abs(found - expected) / reach, 0.0f, 1.0f);
}

// The four texels around a point of the previous image and what each weighs in bilinear filtering;
// multiply by history_weight() of each and divide by the sum.
struct BilinearTaps {
  vec2 first;    // texel of least x and y, may be -1 or beyond the last: clamp each read
  vec4 weights;  // of first, first + (1,0), first + (0,1), first + (1,1); their sum is 1
};

ALCOVE_INLINE BilinearTaps bilinear_taps(vec2 uv, vec2 size_px) {
  float x = uv.x * size_px.x - 0.5f;
  float y = uv.y * size_px.y - 0.5f;
  BilinearTaps taps;
  taps.first = vec2(floor(x), floor(y));
  float u = x - taps.first.x;
  float v = y - taps.first.y;
  taps.weights = vec4((1.0f - u) * (1.0f - v), u * (1.0f - v), (1.0f - u) * v, u * v);
  return taps;
}

ALCOVE_MATHS_END

#endif
