// The results of a texel, and what reconstruct.comp and reconstruct_half.comp both store of them.
#ifndef ALCOVE_RECONSTRUCT_STORE_H
#define ALCOVE_RECONSTRUCT_STORE_H

#include "maths/bent_normal.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "reconstruct_filter.h"

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

#endif
