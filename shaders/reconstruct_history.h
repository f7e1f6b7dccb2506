// Temporal accumulation, the part of reconstruct.comp with HISTORY: reads the history where the
// surface was in the previous frame, rejects texels of other surfaces, and adds this frame.
#ifndef ALCOVE_RECONSTRUCT_HISTORY_H
#define ALCOVE_RECONSTRUCT_HISTORY_H

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

float log_inverse_depth(float inverse_depth, float unit) {
  return kPerspective ? log2(inverse_depth * unit) : inverse_depth;
}

// The position of a surface in the image of the previous frame.
struct Previous {
  vec2 position;  // texels, clamped to the centres of the outermost ones
  float depth;    // linear, over the depth now in perspective; positive
  bool seen;      // it was on the image
  bool moves;     // the surface moved, not only the camera
};

Previous reproject(Surface surface) {
  vec2 centre = surface.centre;
  vec4 from = kPerspective ? vec4(centre, 1.0, surface.inverse_depth)
                           : vec4(centre, surface.inverse_depth, 1.0);
  vec4 to = from * parameters.previous_from_pixel;
  vec2 position = to.xy * (1.0 / to.z);
  Previous previous;
  previous.depth = to.w;
  previous.moves = false;
  if (kMotion) {
    vec2 here = centre * parameters.previous_extent.zw;
    vec2 motion =
        texelFetch(motion_image, surface.pixel, 0).rg * parameters.motion.xy + parameters.motion.zw;
    // More than the rounding of motion vectors, which is 2^-11 in half precision.
    float apart = distance(here - motion, position);
    previous.moves = apart > 0.1 + length(motion) * (1.0 / 512.0);
    position = here - motion;
  }
  position *= 1.0 / float(kTexelSize);
  vec2 within = clamp(position, vec2(0.5), parameters.previous_extent.xy);
  // A NaN fails the comparison.
  vec2 outside = abs(position - within);
  previous.seen = to.z > 0.0 && max(outside.x, outside.y) <= 0.5;
  previous.position = previous.seen ? within : vec2(0.5);
  return previous;
}

// Returns the bilinear weights of four texels in the order of textureGather.
vec4 bilinear_weights(vec2 part) {
  vec2 rest = 1.0 - part;
  return vec4(rest.x * part.y, part.x * part.y, part.x * rest.y, rest.x * rest.y);
}

vec4 gather_offsets(float x, float y, vec2 part) {
  float left = -part.x * x;
  float top = -part.y * y;
  float right = left + x;
  float bottom = top + y;
  return vec4(left + bottom, right + bottom, right + top, left + top);
}

// Motion vectors do not say how far a moving surface has come nearer. The texel that lies nearest
// to the expected depth does, if it lies within `limit` of it.
vec4 follow_depth(vec4 differences, float limit) {
  vec4 apart = abs(differences);
  float least = min(min(apart.x, apart.y), min(apart.z, apart.w));
  if (least > limit) {
    return differences;
  }
  float shift = apart.x == least   ? differences.x
                : apart.y == least ? differences.y
                : apart.z == least ? differences.z
                                   : differences.w;
  return differences - shift;
}

#ifdef HALF
#include "reconstruct_half_history.h"
#else
#include "reconstruct_pixel_history.h"
#endif

// The width of a tile in texels, at least 1.
const int kTileTexels = kTileSize > kTexelSize ? kTileSize / kTexelSize : 1;

// With tiles of 4 texels few samples are a texel's own even in time, so the window stays wider.
const float kWidth = kTileTexels > 2 ? 2.5 : 1.0;

// Returns 0.125 / w^2 for a filter window of w pixels. The window narrows as the history gathers
// weight, down to a smallest width. If the history is read at the centre of a texel, the smallest
// width is `own` texels. Between centres it is larger, because the interpolation of the history
// blurs there anyway.
float window_of(History history) {
  const float own = 0.58 * kWidth;
  const float per_squared_texel = 1.0 / float(kTexelSize * kTexelSize);
  return min(0.125 * per_squared_texel / (own * own + 2.6 * history.between),
             parameters.inverse_squared_window * (3.0 * history.weight + 1.0));
}

// Returns the factor, at least 1, on the weight of a neighbour's distance from the tangent plane,
// compared with a first frame. The more samples of its own a pixel has, the less it needs those of
// other surfaces. Fitted to the error
// after 4 and 32 frames at each tile size (`alcove compare --frames`).
float plane_weight_growth(float weight) {
  const float own = 1.0 / float(kTileTexels * kTileTexels);  // traced frames per frame
  return min(1.0 + 12.0 * own * weight, 5.0);
}

// If objects move, visibility also changes on surfaces at rest. Where the mean of the last few
// frames differs from the mean of all frames by more than noise, it replaces the latter.
void follow_change(inout History history, float now, float open) {
  history.recent = update_recent(history.recent, history.weight, now, open);
  float changed =
      history.weight > 0.0 ? visibility_changed(history.occlusion, history.recent) : 0.0;
  history.occlusion = mix(history.occlusion, history.recent, changed);
  history.weight = mix(history.weight, min(history.weight, kRecentFrames), changed);
}

void clamp_history(inout History history, Sums now) {
  vec3 moments = now.moments / now.moments.x;
  float before = 1.0 - history.occlusion;
  float after =
      clamp_to_spread(before, spread_of_sums(moments.y, moments.z, 1.0), parameters.clamp_width);
  if (history.weight > 0.0) {
    history.occlusion = 1.0 - after;
    history.weight = weight_after_clamp(history.weight, before, after, 0.25);
  }
}

// Returns the sums over the neighbourhood in this frame. A pixel with hardly any history gets the
// wider neighbourhood of a first frame.
Sums sum_neighbourhood(Surface surface, History history, float window) {
  if (kFresh) {
    Sums sums = no_sums();
    add_ring(sums, surface, window, 0);
    return sums;
  }
  Sums sums = sum_near(surface, window);
  if (kFilterRadius > kNearRadius && history.weight < 1.5) {
    add_ring(sums, surface, window, kNearRadius);
  }
  return sums;
}

void reconstruct(Surface surface) {
  History history = no_history();
  if (!kFresh) {
    history = kStatic ? read_static(surface) : read_moving(surface);
  }
  surface.plane_weight *= plane_weight_growth(history.weight);
  float window = window_of(history);
  Sums now = sum_neighbourhood(surface, history, window);
  if (kClamp) {
    clamp_history(history, now);
  }
  if (kMotion) {
    follow_change(history, now.occluded / max(now.open, 1e-37), now.open);
  }
  // The sums are not normalised: a frame that traced the pixel itself has more weight than a frame
  // that traced its neighbours. They are scaled by the number of traced pixels per area of the
  // window, so that the mean weight of a frame is about 1 for every window and tile size.
  float scale = 1.3 * float(kTileSize * kTileSize) * window;
  float open = max(scale * now.open, 1e-37);
  float total = history.weight + open;
  float inverse_total = 1.0 / total;
  Result result;
  result.occlusion =
      saturate((history.weight * history.occlusion + scale * now.occluded) * inverse_total);
  if (kBentNormal) {
    vec3 fresh =
        converged_residual(now.residual, now.expected_residual, 1.0 - result.occlusion) * scale;
    result.residual = (history.weight * history.residual + fresh) * inverse_total;
  }
  result.lobe =
      kLobe ? (history.weight * history.lobe + scale * now.lobe) * inverse_total : vec2(0.0);
  float recent = kMotion ? history.recent : result.occlusion;
  store_history(surface, result, total, recent);
}

#endif
