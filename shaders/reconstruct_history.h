// The steps of reconstruct.comp and reconstruct_half.comp: the filter, and in frames with a history
// temporal accumulation. It reads the history at the position that the surface had in the previous
// frame, rejects texels of other surfaces, and adds the samples of this frame.
#ifndef ALCOVE_RECONSTRUCT_HISTORY_H
#define ALCOVE_RECONSTRUCT_HISTORY_H

#include "fetch_quad.h"
#include "maths/history.h"
#include "reconstruct_filter.h"
#include "reconstruct_previous.h"
#include "reconstruct_store.h"

// Each of the two programs defines these functions for its own texels.
Surface fetch_surface(Place place);
// The history at the four texels around `uv`, the corner that they share; `part` is the position
// between them.
HistoryTexels gather_history(Surface surface, Previous previous, vec2 part, vec2 uv);
// Returns the occlusion, the weight and HistoryTexels::recents for means over four texels.
float occlusion_of_mean(float mean);
float mean_weight(float mean, float occlusion);
float recent_of_mean(float mean, float otherwise);
// The rounding error of a stored depth, and kDepthMotion, both in the units of
// HistoryTexels::distances.
float history_slack(Surface surface);
float moved_distance(Surface surface);
// The history that is stored at the texel itself, without residual and lobe.
History fetch_history(Surface surface);
// Stores the results and the history of a texel. `recent` is the occlusion of the last few frames.
void store_history(Surface surface, Result result, float weight, float recent);
// Stores the results of a frame without a history.
void store_alone(Surface surface, Result result);

// Reads the history between four texels. A texel's weight is its bilinear weight, reduced with the
// distance of its depth from the surface's tangent plane. Of texels that agree by less than a
// twentieth in all (chosen) there is no history.
History read_moving(Surface surface) {
  Previous previous = reproject(surface);
  vec2 part = fract(previous.position);
  // The corner that the four texels share, so that no rounding can move the footprint.
  vec2 uv = (previous.position + 1.0 - part) * parameters.history_texel;
  HistoryTexels texels = gather_history(surface, previous, part, uv);
  if (kMotion) {
    if (previous.moves) texels.distances = follow_depth(texels.distances, moved_distance(surface));
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
  if (kMotion)
    history.recent = recent_of_mean(dot(weights, texels.recents) * scale, history.occlusion);
#ifdef BENT
  // The difference from 0 is weighted, so that the rounding of weights does not change a 0.
  vec4 x = textureGather(sampler2D(bent_history_image, nearest_sampler), uv, 0) - kZeroHalfResidual;
  vec4 y = textureGather(sampler2D(bent_history_image, nearest_sampler), uv, 1) - kZeroHalfResidual;
  vec4 z = textureGather(sampler2D(bent_history_image, nearest_sampler), uv, 2) - kZeroHalfResidual;
  vec3 sum = vec3(dot(weights, x), dot(weights, y), dot(weights, z));
  history.residual = known ? sum * (scale * kHalfResidualUnit) : vec3(0.0);
  // From the view space of the previous frame.
  history.residual = history.residual * mat3(parameters.previous_from_view);
#endif
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
#ifdef BENT
  history.residual =
      unpack_half_residual(texelFetch(bent_history_image, surface.place.texel, 0).xyz);
#endif
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_history_image, surface.place.texel, 0).r);
  history.lobe = lobe.open * vec2(lobe.occlusion, 1.0);
#endif
  return history;
}

// The width of a tile in texels, at least 1.
const int kTileTexels = kTileSize > kTexelSize ? kTileSize / kTexelSize : 1;

// Returns Window::sharpness. The window narrows as the weight of the history grows, down to a
// smallest width, which is larger between the centres of texels of the history. A pixel of a 2x2
// tile is traced twice in eight frames. If its window narrowed as fast as these frames come, it
// would show noise. A smaller factor blurs: 0.4 increased the error of the helmet after 32 frames
// by 0.0007, that of 4x4 tiles by 0.0018. Fitted after 4 to 32 frames (`alcove compare --frames`).
float sharpness_of(History history) {
  float narrowing = kTileTexels > 2 ? 3.0 * history.weight : 0.5 * history.weight;
  return min(1.0 / (parameters.smallest_window.x + parameters.smallest_window.y * history.between),
             parameters.first_sharpness * (narrowing + 1.0));
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

// Returns the sums over the traced pixels around the texel in this frame. A texel with hardly any
// history gets the wider neighbourhood of a first frame.
Sums sum_neighbourhood(Surface surface, History history, Window window) {
  if (kFresh || (history.weight < 1.5 && !surface.sky)) return sum_wide(surface, window);
  return sum_near(surface, window);
}

void accumulate(Surface surface) {
  History history = no_history();
  if (!kFresh) history = kStatic ? read_static(surface) : read_moving(surface);
  float growth = plane_weight_growth(history.weight);
  Window window = Window(sharpness_of(history), growth * growth);
  Sums now = sum_neighbourhood(surface, history, window);
  if (kMotion) {
    // If no traced pixel lies on the surface, nothing is known of a change.
    const float unchanged = 0.01;
    follow_change(history,
                  (now.occluded + unchanged * history.recent) / max(now.open + unchanged, 1e-37),
                  now.open * (near_scale() / kWideScale / parameters.wide_sharpness));
  }
  // The sums are not normalised: a frame that traced the pixel itself has more weight than a frame
  // that traced its neighbours.
  float scale = near_scale() * float(kTileSize * kTileSize) * window.sharpness;
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

// Reconstructs one texel in each block of the group's column, up to the texel `last`.
void reconstruct_column(ivec2 last) {
  Place place = first_place();
  [[dont_unroll]] for (int block = 0; block < kBlocks; ++block) {
    if (place.texel.x <= last.x && place.texel.y <= last.y) {
      Surface surface = fetch_surface(place);
      set_plane(surface);
      if (kHistory)
        accumulate(surface);
      else
        store_alone(surface, result_of(sum_wide(surface, Window(parameters.first_sharpness, 1.0))));
    }
    move_to_next_block(place);
  }
}

#endif
