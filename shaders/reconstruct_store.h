// Stores the results of reconstruct.comp: the outputs, or the texels that the upsampling pass and
// the next frame read.
#ifndef ALCOVE_RECONSTRUCT_STORE_H
#define ALCOVE_RECONSTRUCT_STORE_H

#include "maths/bent_normal.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "reconstruct_filter.h"
#ifdef HALF
#include "reconstruct_half_surface.h"
#else
#include "reconstruct_pixel_surface.h"
#endif

// The results of a pixel or of a texel.
struct Result {
  float occlusion;  // [0,1]
  vec3 residual;    // of the bent normal
  vec2 lobe;        // occluded, open
};

// Returns the results of sums over a wide neighbourhood, without a history.
Result result_of(Sums sums) {
  float scale = 1.0 / max(sums.open, 1e-37);
  Result result = Result(saturate(sums.occluded * scale), vec3(0.0), sums.lobe);
  if (kBentNormal) {
    result.residual =
        converged_residual(sums.residual, sums.expected_residual, 1.0 - result.occlusion) * scale;
  }
  return result;
}

// Returns a number in [0,1) that is evenly distributed over neighbouring texels and over frames:
// interleaved gradient noise [Jimenez 2014].
float dither_of(Place place) { return fract(52.9829189 * fract(place.dither)); }

// Stores residual and lobe as history and upsampling read them.
void store_kept(Surface surface, Result result, float dither) {
#ifdef BENT
  vec3 residual = surface.sky ? vec3(0.0) : result.residual;
  imageStore(next_bent_history_image, surface.place.texel, pack_half_residual(residual, dither));
#endif
#ifdef SPECULAR
  // The comparisons are false for NaN, which would stay in the history.
  bool valid = !surface.sky && result.lobe.x >= 0.0 && result.lobe.y < 1e30;
  LobeTexel lobe = LobeTexel(valid ? result.lobe.x / max(result.lobe.y, 1e-30) : 0.0,
                             valid ? result.lobe.y : 0.0);
  imageStore(next_lobe_history_image, surface.place.texel, uvec4(pack_lobe_texel(lobe, dither)));
#endif
}

#ifdef HALF

// Stores a texel for upsampling and for the next frame. `recent`, the occlusion of the last few
// frames, is stored only with kMotion.
void store_half(Surface surface, Result result, float weight, float recent) {
  HalfTexel texel = HalfTexel(result.occlusion, weight, surface.tilt);
  imageStore(half_image, surface.place.texel, surface.sky ? vec4(0.0) : pack_half_texel(texel));
  float depth = surface.sky ? sky_inverse_depth(kPerspective)
                            : half_texel_depth(surface.inverse_depth, recent, kMotion);
  imageStore(half_depth_image, surface.place.texel, vec4(depth));
}

#else

// Stores the outputs of a pixel.
void store(Surface surface, Result result) {
  if (!is_written(surface.place.texel)) return;
  ivec2 texel = in_outputs(surface.place.texel);
  float visibility = surface.sky ? 1.0 : 1.0 - result.occlusion;
  if (kVisibility) {
    float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
    imageStore(visibility_image, texel, vec4(kShaped ? shaped : visibility));
  }
#ifdef BENT
  vec3 residual = surface.sky ? vec3(0.0) : result.residual;
  vec3 bent = finish_bent_normal(residual, visibility, traced_normal(surface));
  imageStore(bent_normal_image, texel, vec4(mat3(parameters.normal_from_view) * bent, 0.0));
#endif
#ifdef SPECULAR
  float occlusion = surface.sky ? 0.0 : saturate(result.lobe.x / max(result.lobe.y, 1e-30));
  imageStore(specular_image, texel, vec4(1.0 - occlusion));
#endif
}

#endif

// Stores the results of a frame without a history.
void store_alone(Surface surface, Result result) {
#ifdef HALF
  store_half(surface, result, 0.0, 0.0);
  store_kept(surface, result, 0.5);
#else
  store(surface, result);
#endif
}

#endif
