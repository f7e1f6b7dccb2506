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
  vec2 position;  // texels from the centre of the first one, clamped to those of the first and the
                  // last that were written
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
    // More than the rounding of motion vectors, which is 2^-11 in half precision.
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
  vec4 weights;  // for mean_weight()
  vec4 recents;  // for recent_of_mean(); only with kMotion
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
  vec2 part = fract(previous.position);
  // The corner that the four texels share, so that no rounding can move the footprint.
  vec2 uv = (previous.position + 1.0 - part) * parameters.history_texel;
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
  float weight = mean_weight(dot(weights, texels.weights) * scale, mean);
  weight = min(weight, parameters.largest_weight);
  history.weight = known ? weight_after_blur(weight, variance, 1.0 - total) : 0.0;
  history.between = dot(part, 1.0 - part);
  if (kMotion) {
    history.recent = recent_of_mean(dot(weights, texels.recents) * scale, history.occlusion);
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
    history.residual =
        unpack_half_residual(texelFetch(bent_history_image, surface.place.texel, 0).xyz);
  }
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_history_image, surface.place.texel, 0).r);
  history.lobe = lobe.open * vec2(lobe.occlusion, 1.0);
#endif
  return history;
}

// The width of a tile in texels, at least 1.
const int kTileTexels = kTileSize > kTexelSize ? kTileSize / kTexelSize : 1;

// How fast the squared width of the filter window falls with the weight of the history: it is
// divided by 1 + kNarrowing * weight. A pixel of a 2x2 tile is traced twice in eight frames. If its
// window narrowed as fast as these frames come, it would show the noise of two traces. A smaller
// value blurs: 0.4 increased the error of the helmet after 32 frames by 0.0007, and that of tiles
// of 4x4 pixels by 0.0018. Fitted to the error after 4 to 32 frames (`alcove compare --frames`).
const float kNarrowing = kTileTexels > 2 ? 3.0 : 0.5;

// Returns Window::sharpness. The window narrows as the weight of the history grows, down to a
// smallest width, which is larger between the centres of texels of the history.
float sharpness_of(History history) {
  return min(1.0 / (parameters.smallest_window.x + parameters.smallest_window.y * history.between),
             parameters.first_sharpness * (kNarrowing * history.weight + 1.0));
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
  vec3 moments = now.moments / max(now.moments.x, 1e-30);
  float before = 1.0 - history.occlusion;
  float after =
      clamp_to_spread(before, spread_of_sums(moments.y, moments.z, 1.0), parameters.clamp_width);
  if (history.weight > 0.0 && now.moments.x > 0.01) {
    history.occlusion = 1.0 - after;
    history.weight = weight_after_clamp(history.weight, before, after, 0.25);
  }
}

// Returns the sums over the traced pixels around the texel in this frame. A texel with hardly any
// history gets the wider neighbourhood of a first frame.
Sums sum_neighbourhood(Surface surface, History history, Window window) {
  if (kFresh || (history.weight < 1.5 && !surface.sky)) {
    return sum_wide(surface, window);
  }
  return sum_near(surface, window);
}

void reconstruct(Surface surface) {
  History history = no_history();
  if (!kFresh) {
    history = kStatic ? read_static(surface) : read_moving(surface);
  }
  float growth = plane_weight_growth(history.weight);
  Window window = Window(sharpness_of(history), growth * growth);
  Sums now = sum_neighbourhood(surface, history, window);
  if (kClamp) {
    clamp_history(history, now);
  }
  if (kMotion) {
    // If no traced pixel lies on the surface, nothing is known of a change.
    const float unchanged = 0.01;
    follow_change(history,
                  (now.occluded + unchanged * history.recent) / max(now.open + unchanged, 1e-37),
                  now.open * (kNearScale / kWideScale / parameters.wide_sharpness));
  }
  // The sums are not normalised: a frame that traced the pixel itself has more weight than a frame
  // that traced its neighbours.
  float scale = kNearScale * float(kTileSize * kTileSize) * window.sharpness;
  float total = max(history.weight + scale * now.open, 1e-37);
  float inverse_total = 1.0 / total;
  Result result;
  result.occlusion =
      clamp((history.weight * history.occlusion + scale * now.occluded) * inverse_total, 0.0, 1.0);
  if (kBentNormal) {
    vec3 fresh =
        converged_residual(now.residual, now.expected_residual, 1.0 - result.occlusion) * scale;
    result.residual = (history.weight * history.residual + fresh) * inverse_total;
  }
  result.lobe =
      kLobe ? (history.weight * history.lobe + scale * now.lobe) * inverse_total : vec2(0.0);
  store_history(surface, result, total, kMotion ? history.recent : kNoRecent);
}

#endif
