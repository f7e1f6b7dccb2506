// The history of texels of 2x2 pixels, whose format is HalfTexel, as the previous frame stored it
// for upsampling. It is the part of reconstruct_history.h that is compiled with HALF.
#ifndef ALCOVE_RECONSTRUCT_HALF_HISTORY_H
#define ALCOVE_RECONSTRUCT_HALF_HISTORY_H

#include "maths/half_texel.h"
#include "reconstruct_previous.h"
#include "reconstruct_store.h"

float history_slack(Surface surface) { return parameters.history_slack; }

float moved_distance(Surface surface) {
  return kDepthMotion * parameters.history_sharpness * surface.n_dot_v *
         (kPerspective ? 1.0 : 1.0 / parameters.history_depth_scale.z);
}

HistoryTexels gather_history(Surface surface, Previous previous, vec2 part, vec2 uv) {
  vec4 depths = textureGather(sampler2D(history_depth_image, nearest_sampler), uv);
  float sharpness = parameters.history_sharpness * surface.n_dot_v;
  float per_depth = kPerspective ? previous.depth * surface.depth : 1.0;
  float expected = kPerspective ? 1.0 : previous.depth;
  // The slope hardly changes from frame to frame, but for the scale of all depths.
  vec2 gradient = surface.slope * (parameters.history_sharpness * float(kTexelSize));
  HistoryTexels texels;
  texels.distances =
      depths * (per_depth * sharpness) - gather_offsets(gradient, part, expected * sharpness);
  texels.occlusions = textureGather(sampler2D(history_image, nearest_sampler), uv, 0);
  texels.weights = textureGather(sampler2D(history_image, nearest_sampler), uv, 1);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    texels.recents[i] = kMotion ? half_texel_recent_code(depths[i]) : 0.0;
  }
  return texels;
}

float recent_of_mean(float mean, float otherwise) { return half_recent_of_code(mean, otherwise); }

float occlusion_of_mean(float mean) { return mean; }

// Returns the weight for the mean of HistoryTexels::weights.
float mean_weight(float mean, float /*occlusion*/) { return mean * kHalfTexelWeightUnit; }

History fetch_history(Surface surface) {
  float depth = texelFetch(history_depth_image, surface.place.texel, 0).r;
  vec4 stored = texelFetch(history_image, surface.place.texel, 0);
  float distance = abs(depth - surface.inverse_depth) *
                   (surface.depth * parameters.history_sharpness * surface.n_dot_v);
  History history = no_history();
  history.occlusion = stored.x;
  history.recent = half_recent_of_code(half_texel_recent_code(depth), stored.x);
  history.weight =
      distance <= kSameTexel + history_slack(surface) ? stored.y * kHalfTexelWeightUnit : 0.0;
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  store_half(surface, result, weight, recent);
  store_kept(surface, result, dither_of(surface.place));
}

#endif
