// The history of pixels, whose format is HistoryTexel. It is the part of reconstruct_history.h that
// is compiled without HALF.
#ifndef ALCOVE_RECONSTRUCT_PIXEL_HISTORY_H
#define ALCOVE_RECONSTRUCT_PIXEL_HISTORY_H

#include "maths/history.h"
#include "reconstruct_previous.h"
#include "reconstruct_store.h"

// Returns the change of a stored depth for a change of depth: per relative change in perspective
// views, and per change of 1 in orthographic views. `scale` is the x or z of history_depth_scale.
float stored_per_depth(float scale) { return kPerspective ? 1.442695 * scale : scale; }

// The logarithm of the inverse depth in perspective, the depth in orthographic views.
float log_inverse_depth(Surface surface) {
  return kPerspective ? log2(surface.inverse_depth * parameters.history_unit)
                      : surface.inverse_depth;
}

float history_slack(Surface surface) { return parameters.history_slack * surface.n_dot_v; }

float moved_distance(Surface surface) {
  return kDepthMotion * parameters.history_sharpness * surface.n_dot_v *
         (kPerspective ? stored_per_depth(abs(parameters.history_depth_scale.z)) : 1.0);
}

HistoryTexels gather_history(Surface surface, Previous previous, vec2 part, vec2 uv) {
  vec4 depths = textureGather(sampler2D(history_image, nearest_sampler), uv, 0);
  vec4 values = textureGather(sampler2D(history_image, nearest_sampler), uv, 1);
  float log_depth =
      kPerspective ? log_inverse_depth(surface) - log2(previous.depth) : previous.depth;
  float sharpness = parameters.history_sharpness * surface.n_dot_v;
  float expected = log_depth * parameters.history_depth_scale.z + parameters.history_depth_scale.w;
  // The change of a stored depth per pixel, to first order; it hardly changes from frame to frame.
  vec2 gradient = surface.slope * parameters.history_slope;
  HistoryTexels texels;
  texels.distances = depths * sharpness - gather_offsets(gradient, part, expected * sharpness);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    texels.weights[i] = texel_codes(values[i]);
    texels.occlusions[i] = fract(texels.weights[i]);
    texels.recents[i] = kMotion ? texel_recent_code(depths[i]) : 0.0;
  }
  return texels;
}

float recent_of_mean(float mean, float otherwise) { return recent_of_code(mean, otherwise); }

float occlusion_of_mean(float mean) { return texel_occlusion(mean); }

// Returns the weight for the mean of HistoryTexels::weights and the mean of the occlusions.
float mean_weight(float mean, float occlusion) { return weight_of_code(mean - occlusion); }

History fetch_history(Surface surface) {
  HistoryTexel texel = unpack_history_texel(texelFetch(history_image, surface.pixel, 0).xy);
  float expected = history_depth(parameters.history_depth_scale.xy, log_inverse_depth(surface));
  float distance = abs(texel.depth - expected) * (parameters.history_sharpness * surface.n_dot_v);
  History history = no_history();
  history.occlusion = texel.occlusion;
  history.recent = texel.recent;
  history.weight = distance <= kSameTexel + history_slack(surface) ? texel.weight : 0.0;
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  float dither = dither_of(surface.place);
  float depth = history_depth(parameters.history_depth_scale.xy, log_inverse_depth(surface));
  HistoryTexel texel = HistoryTexel(depth, recent, result.occlusion, weight);
  vec2 stored = surface.sky ? vec2(0.0) : pack_history_texel(texel, dither);
  imageStore(next_history_image, surface.place.texel, vec4(stored, 0.0, 0.0));
  store_kept(surface, result, dither);
  store(surface, result);
}

#endif
