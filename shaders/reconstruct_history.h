// Temporal accumulation: the part of reconstruct.comp that is compiled with HISTORY. It reads the
// history at the position that the surface had in the previous frame, rejects texels of other
// surfaces, and adds the samples of this frame.
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

// The largest distance, in the units of HistoryTexels::distances, at which a texel of a static
// image keeps its history. It is the distance at which the weight of a texel in a moving image, (1
// - distance)^2, is 0.05.
const float kSameTexel = 0.776;

// The position of a surface in the image of the previous frame.
struct Previous {
  vec2 position;  // texels, clamped to the centres of the outermost ones
  float depth;    // in perspective over the depth now, and positive; in orthographic views linear
  bool seen;      // it was on the image
  bool moves;     // the surface moved, not only the camera
};

Previous reproject(Surface surface) {
  vec2 centre = surface.centre;
  vec4 from = kPerspective ? vec4(centre, 1.0, surface.inverse_depth)
                           : vec4(centre, surface.inverse_depth, 1.0);
  vec4 to = from * parameters.previous_from_pixel;
  vec2 position = to.xy * (1.0 / max(to.z, 1e-20));
  Previous previous;
  previous.depth = kPerspective ? max(to.w, 1e-30) : to.w;
  previous.moves = false;
  if (kMotion) {
    vec2 here = centre * parameters.previous_extent.zw;
    vec2 motion =
        texelFetch(motion_image, surface.pixel, 0).rg * parameters.motion.xy + parameters.motion.zw;
    // More than the rounding of motion vectors, which is 2^-11 in half precision.
    float apart = distance(here - motion, position);
    previous.moves = apart > 0.1 + length(motion) * (1.0 / 512.0);
    position = here - motion;
    // A NaN would stay in the history.
    position = position == position ? position : vec2(-1e6);
  }
  position *= 1.0 / float(kTexelSize);
  previous.position = clamp(position, vec2(0.5), parameters.previous_extent.xy);
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
  float left = first - part.x * gradient.x;
  float top = -part.y * gradient.y;
  float right = left + gradient.x;
  float bottom = top + gradient.y;
  return vec4(left + bottom, right + bottom, right + top, left + top);
}

float sum_of(vec4 v) { return v.x + v.y + v.z + v.w; }

// Returns the differences of depth of four texels from the expected depth of a moving surface,
// minus the smallest of them if that is at most `limit`. Motion vectors do not tell how far a
// surface has moved towards the eye; the texel that is nearest to the expected depth does.
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

// The values of the history at the four texels around a position, in the order of textureGather.
struct HistoryTexels {
  // From the surface's tangent plane, in units at which a texel of another depth no longer counts.
  vec4 distances;
  vec4 occlusions;
  vec4 codes;    // of the weights
  vec4 recents;  // as History::recent; only with kMotion
};

#ifdef HALF
#include "reconstruct_half_history.h"
#else
#include "reconstruct_pixel_history.h"
#endif

// Reads the history between four texels. A texel's weight is its bilinear weight, reduced with the
// distance of its depth from the surface's tangent plane.
History read_moving(Surface surface) {
  Previous previous = reproject(surface);
  vec2 part = fract(previous.position - 0.5);
  // The corner that the four texels share, so that no rounding can move the footprint.
  vec2 uv = (previous.position + 0.5 - part) * parameters.history_texel;
  HistoryTexels texels = gather_history(surface, previous, part, uv);
  if (kMotion) {
    if (previous.moves) {
      texels.distances = follow_depth(texels.distances, moved_distance(surface));
    }
  }
  vec4 weights =
      bilinear_weights(part) * history_agreement(texels.distances, history_slack(surface));
  float total = sum_of(weights);
  bool known = previous.seen && total >= 0.05;
  float scale = 1.0 / max(total, 0.05);
  History history = no_history();
  vec4 weighted = weights * texels.occlusions;
  float mean = sum_of(weighted) * scale;
  history.occlusion = occlusion_of_mean(mean);
  float variance = max(dot(weighted, texels.occlusions) * scale - mean * mean, 0.0);
  float weight = weight_of_mean(dot(weights, texels.codes) * scale);
  weight = min(weight, parameters.largest_weight);
  history.weight = known ? weight_after_blur(weight, variance, 1.0 - total) : 0.0;
  history.between = dot(part, 1.0 - part);
  if (kMotion) {
    history.recent = dot(weights, texels.recents) * scale;
  }
  if (kBentNormal) {
    // The difference from 0 is weighted, so that the rounding of weights does not change a 0.
    vec4 x = textureGather(bent_history_image, uv, 0) - kZeroHalfResidual;
    vec4 y = textureGather(bent_history_image, uv, 1) - kZeroHalfResidual;
    vec4 z = textureGather(bent_history_image, uv, 2) - kZeroHalfResidual;
    vec3 sum = vec3(dot(weights, x), dot(weights, y), dot(weights, z));
    history.residual = known ? sum * (scale * kHalfResidualUnit) : vec3(0.0);
    // From the view space of the previous frame.
    history.residual = history.residual * mat3(parameters.previous_from_view);
  }
#ifdef SPECULAR
  uvec4 lobes = fetch_quad(lobe_history_image, ivec2(floor(previous.position + 0.5)));
  [[unroll]] for (int i = 0; i < 4; ++i) {
    LobeTexel lobe = unpack_lobe_texel(lobes[i]);
    history.lobe += weights[i] * scale * lobe.open * vec2(lobe.occlusion, 1.0);
  }
#endif
  return history;
}

// Reads the history at the texel itself, for a static image. The depth is compared too, because
// objects may have moved without motion vectors.
History read_static(Surface surface) {
  History history = fetch_history(surface);
  history.weight = min(history.weight, parameters.largest_weight);
  if (kBentNormal) {
    history.residual = unpack_half_residual(texelFetch(bent_history_image, surface.texel, 0).xyz);
  }
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_history_image, surface.texel, 0).r);
  history.lobe = lobe.open * vec2(lobe.occlusion, 1.0);
#endif
  return history;
}

// The width of a tile in texels, at least 1.
const int kTileTexels = kTileSize > kTexelSize ? kTileSize / kTexelSize : 1;

// With tiles of 4 texels few samples are a texel's own even in time, so the window stays wider.
const float kWidth = kTileTexels > 2 ? 2.5 : 1.0;

// How fast the squared width of the filter window falls with the weight of the history: it is
// divided by 1 + kNarrowing * weight. A pixel of a 2x2 tile is traced twice in eight frames. If its
// window narrowed as fast as these frames come, it would show the noise of two traces. A smaller
// value blurs: 0.4 increased the error of the helmet after 32 frames by 0.0007, and that of tiles
// of 4x4 pixels by 0.0018. Fitted to the error after 4 to 32 frames (`alcove compare --frames`).
const float kNarrowing = kTileTexels > 2 ? 3.0 : 0.5;

// Returns 0.125 / w^2 for a filter window of w pixels. The window narrows as the weight of the
// history grows, down to a smallest width. At the centre of a texel of the history, this smallest
// width is `own` texels. Between centres it is larger, because the interpolation of the history
// blurs there anyway.
float window_of(History history) {
  const float own = 0.58 * kWidth;
  const float per_squared_texel = 1.0 / float(kTexelSize * kTexelSize);
  return min(0.125 * per_squared_texel / (own * own + 2.6 * history.between),
             parameters.inverse_squared_window * (kNarrowing * history.weight + 1.0));
}

// Returns the factor, at least 1, by which a neighbour's distance from the tangent plane is
// multiplied, compared with a first frame. The more samples of its own a pixel has, the less it
// needs those of other surfaces. Fitted to the error after 4 and 32 frames at each tile size
// (`alcove compare --frames`).
float plane_weight_growth(float weight) {
  const float own = 1.0 / float(kTileTexels * kTileTexels);  // traced frames per frame
  return min(1.0 + 12.0 * own * weight, 5.0);
}

// Replaces the mean of all frames by the mean of the last few frames if the two differ by more than
// noise. If objects move, visibility also changes on surfaces that do not move.
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

// Returns the sums over the traced pixels around the pixel in this frame. A pixel with hardly any
// history gets the wider neighbourhood of a first frame.
Sums sum_neighbourhood(Surface surface, History history, Window window) {
  if (kFresh) {
    return sum_wide(surface, window);
  }
  Sums sums = sum_near(surface, window);
  if (kFilterRadius > kNearRadius && history.weight < 1.5) {
    add_ring(sums, surface, window);
  }
  return sums;
}

void reconstruct(Surface surface) {
  History history = no_history();
  if (!kFresh) {
    history = kStatic ? read_static(surface) : read_moving(surface);
  }
  float growth = plane_weight_growth(history.weight);
  Window window = Window(window_of(history), growth * growth);
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
  float scale = 1.3 * float(kTileSize * kTileSize) * window.inverse_squared_width;
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
  store_history(surface, result, total, kMotion ? history.recent : result.occlusion);
}

#endif
