// The history of texels of 2x2 pixels, included by reconstruct_history.h if HALF is defined. It is
// what the previous frame stored for upsampling (HalfTexel), in formats that texture units unpack.
#ifndef ALCOVE_RECONSTRUCT_HALF_HISTORY_H
#define ALCOVE_RECONSTRUCT_HALF_HISTORY_H

// Returns a weight in [0,1] for each of the four texels around the previous position: 1 if the
// texel's depth lies on the surface's tangent plane, falling to 0 with its distance from it. `part`
// is the position between the centres of the four texels, [0,1].
vec4 depth_agreement(vec4 found, Surface surface, Previous previous, vec2 part) {
  float expected = previous.depth;
  vec2 gradient = surface.gradient * float(kTexelSize);
  float per_depth = 1.0;
  if (kPerspective) {
    // The gradient hardly changes from frame to frame, but for the scale of all depths.
    float scale = 1.0 / max(previous.depth, 1e-30);
    expected = surface.inverse_depth * scale;
    gradient *= scale;
    per_depth = previous.depth * surface.depth;
  }
  vec4 differences = found - (gather_offsets(gradient.x, gradient.y, part) + expected);
  if (kMotion) {
    if (previous.moves) {
      differences =
          follow_depth(differences, kPerspective ? kDepthMotion * expected
                                                 : kDepthMotion / parameters.history_depth_scale.z);
    }
  }
  float sharpness = parameters.history_sharpness * surface.n_dot_v * per_depth;
  vec4 linear = clamp(1.0 + parameters.history_slack - abs(differences) * sharpness, 0.0, 1.0);
  return linear * linear;
}

// Reads the history between four texels.
History read_moving(Surface surface) {
  Previous previous = reproject(surface);
  vec2 first = floor(previous.position - 0.5);
  vec2 part = previous.position - 0.5 - first;
  // The corner that the four texels share, so that no rounding can move the footprint.
  vec2 uv = (first + 1.0) * parameters.history_texel;
  vec4 depths = textureGather(history_depth_image, uv);
  vec4 occlusions = textureGather(history_image, uv, 0);
  vec4 frames = textureGather(history_image, uv, 1);
  vec4 weights = bilinear_weights(part) * depth_agreement(depths, surface, previous, part);
  float total = dot(weights, vec4(1.0));
  bool known = previous.seen && total >= 0.05;
  float scale = 1.0 / max(total, 0.05);
  History history = no_history();
  history.occlusion = dot(weights, occlusions) * scale;
  float squares = dot(weights, occlusions * occlusions) * scale;
  float variance = max(squares - history.occlusion * history.occlusion, 0.0);
  float weight = dot(weights, frames) * (scale * kHalfTexelWeightUnit);
  weight = min(weight, parameters.largest_weight);
  history.weight = known ? weight_after_blur(weight, variance, 1.0 - total) : 0.0;
  history.between = dot(part, 1.0 - part);
  if (kMotion) {
    [[unroll]] for (int i = 0; i < 4; ++i) {
      history.recent += weights[i] * scale * half_texel_recent(depths[i], occlusions[i]);
    }
  }
  if (kBentNormal) {
    vec3 stored = vec3(dot(weights, textureGather(bent_history_image, uv, 0)),
                       dot(weights, textureGather(bent_history_image, uv, 1)),
                       dot(weights, textureGather(bent_history_image, uv, 2)));
    history.residual = known ? unpack_half_residual(stored * scale) : vec3(0.0);
    // From the view space of the previous frame.
    history.residual = history.residual * mat3(parameters.previous_from_view);
  }
#ifdef SPECULAR
  uvec4 lobes = textureGather(lobe_history_image, uv);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    LobeTexel lobe = unpack_lobe_texel(lobes[i]);
    history.lobe += weights[i] * scale * lobe.open * vec2(lobe.occlusion, 1.0);
  }
#endif
  return history;
}

// Reads the history at the texel itself, for a camera that stands still. The depth is compared too,
// because objects may have moved without motion vectors.
History read_static(Surface surface) {
  float depth = texelFetch(history_depth_image, surface.texel, 0).r;
  vec4 stored = texelFetch(history_image, surface.texel, 0);
  float per_depth = kPerspective ? surface.depth : 1.0;
  float sharpness = parameters.history_sharpness * surface.n_dot_v * per_depth;
  bool same = abs(depth - surface.inverse_depth) * sharpness <= 0.78 + parameters.history_slack;
  History history = no_history();
  history.occlusion = stored.x;
  history.recent = half_texel_recent(depth, stored.x);
  history.weight = same ? min(stored.y * kHalfTexelWeightUnit, parameters.largest_weight) : 0.0;
  if (kBentNormal) {
    history.residual = unpack_half_residual(texelFetch(bent_history_image, surface.texel, 0).xyz);
  }
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_history_image, surface.texel, 0).r);
  history.lobe = lobe.open * vec2(lobe.occlusion, 1.0);
#endif
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  store_half(surface, result, weight, recent);
  store_kept(surface, result, dither_of(surface.texel));
}

#endif
