// The history of pixels, the part of reconstruct_history.h without HALF: four bytes a pixel.
#ifndef ALCOVE_RECONSTRUCT_PIXEL_HISTORY_H
#define ALCOVE_RECONSTRUCT_PIXEL_HISTORY_H

// Returns the stored depths of the four texels minus the depths that the surface's tangent plane
// had there.
vec4 depth_differences(uvec4 texels, Surface surface, Previous previous, vec2 part) {
  vec4 found;
  [[unroll]] for (int i = 0; i < 4; ++i) { found[i] = texel_depth(texels[i]); }
  vec2 scale = parameters.history_depth_scale.zw;
  // The gradient of the stored depth to first order; it hardly changes from frame to frame.
  vec2 gradient = surface.gradient * (scale.x * float(kTexelSize));
  float at_position = scale.y;
  if (kPerspective) {
    gradient *= 1.442695 / surface.inverse_depth;
    at_position += scale.x * log_inverse_depth(surface.inverse_depth / max(previous.depth, 1e-30),
                                               parameters.history_unit.y);
  } else {
    at_position += scale.x * previous.depth;
  }
  return found - (gather_offsets(gradient.x, gradient.y, part) + at_position);
}

vec3 residual_of_texel(uint bits) { return unpack_residual(bits); }

// Reads the history between four texels.
History read_moving(Surface surface) {
  Previous previous = reproject(surface);
  vec2 first = floor(previous.position - 0.5);
  vec2 part = previous.position - 0.5 - first;
  // The corner that the four texels share, so that no rounding can move the footprint.
  vec2 uv = (first + 1.0) * parameters.history_texel;
  uvec4 texels = textureGather(history_image, uv);
  vec4 differences = depth_differences(texels, surface, previous, part);
  if (kMotion) {
    if (previous.moves) {
      float limit = kPerspective ? kDepthMotion * 1.442695 * abs(parameters.history_depth_scale.z)
                                 : kDepthMotion;
      differences = follow_depth(differences, limit);
    }
  }
  vec4 shares = bilinear_weights(part);
  float sharpness = parameters.history_sharpness * surface.n_dot_v;
  float total = 0.0;
  float squares = 0.0;
  float log_weight = 0.0;
  History history = no_history();
  vec4 weights;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    float weight =
        shares[i] * history_agreement(differences[i], parameters.history_slack, sharpness);
    weights[i] = weight;
    float occlusion = texel_occlusion(texels[i]);
    total += weight;
    history.occlusion += weight * occlusion;
    squares += weight * occlusion * occlusion;
    log_weight += weight * texel_log_weight(texels[i]);
    if (kMotion) {
      history.recent += weight * texel_recent(texels[i]);
    }
  }
  bool known = previous.seen && total >= 0.05;
  float scale = 1.0 / max(total, 0.05);
  history.occlusion *= scale;
  history.recent *= scale;
  float variance = max(squares * scale - history.occlusion * history.occlusion, 0.0);
  float weight = min(weight_of_log(log_weight * scale), parameters.largest_weight);
  history.weight = known ? weight_after_blur(weight, variance, 1.0 - total) : 0.0;
  history.between = dot(part, 1.0 - part);
  if (kBentNormal) {
    uvec4 residuals = textureGather(bent_history_image, uv);
    [[unroll]] for (int i = 0; i < 4; ++i) {
      history.residual += weights[i] * residual_of_texel(residuals[i]);
    }
    // From the view space of the previous frame.
    history.residual = (history.residual * scale) * mat3(parameters.previous_from_view);
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

// Reads the history at the pixel itself, for a camera that stands still. The depth is compared too,
// because objects may have moved without motion vectors.
History read_static(Surface surface) {
  uint bits = texelFetch(history_image, surface.texel, 0).r;
  float difference =
      texel_depth(bits) -
      history_depth(parameters.history_depth_scale.xy,
                    log_inverse_depth(surface.inverse_depth, parameters.history_unit.x));
  float agreement = history_agreement(difference, parameters.history_slack,
                                      parameters.history_sharpness * surface.n_dot_v);
  History history = no_history();
  history.occlusion = texel_occlusion(bits);
  history.recent = texel_recent(bits);
  float weight = min(weight_of_log(texel_log_weight(bits)), parameters.largest_weight);
  history.weight = agreement >= 0.05 ? weight : 0.0;
  if (kBentNormal) {
    history.residual = residual_of_texel(texelFetch(bent_history_image, surface.texel, 0).r);
  }
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_history_image, surface.texel, 0).r);
  history.lobe = lobe.open * vec2(lobe.occlusion, 1.0);
#endif
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  float dither = dither_of(surface.texel);
  HistoryTexel texel;
  texel.depth = history_depth(parameters.history_depth_scale.xy,
                              log_inverse_depth(surface.inverse_depth, parameters.history_unit.x));
  texel.occlusion = result.occlusion;
  texel.recent = recent;
  texel.log_weight = log_weight_of(weight);
  uint bits = pack_history_texel(texel, dither);
  imageStore(next_history_image, surface.texel, uvec4(surface.sky ? 0u : bits));
  store_kept(surface, result, dither);
  store(surface, result);
}

#endif
