// Part of gtao.comp: the sums of a slice, to which each estimator adds.
#ifndef ALCOVE_GTAO_SLICE_SUM_H
#define ALCOVE_GTAO_SLICE_SUM_H

#include "gtao_bindings.h"
#include "gtao_surface.h"
#include "maths/raw_occlusion.h"

// Sums over the two half-slices of a slice.
struct SliceSum {
  RawOcclusion raw_occlusion;  // visible and open part, weighted by the cosine of the normal,
                               // without what is unobserved
  float visible;               // visible part with what is unobserved; only with kBentNormal
  vec2 bent;          // sum of visible directions: along the slice's direction, along the view's
  RawOcclusion lobe;  // visible part of the GGX lobe and the whole lobe, without what is unobserved
  float roughness;    // of the surface, perceptual
};

SliceSum no_sum(Surface surface) {
  return SliceSum(RawOcclusion(0.0, 0.0), 0.0, vec2(0.0), RawOcclusion(0.0, 0.0),
                  surface.roughness);
}

// Adds the visible part of a half-slice and the part without occluders, of both of which `left_out`
// is unobserved.
void add_arc(inout SliceSum sum, float visible, float open, float left_out) {
  sum.raw_occlusion.visible += visible - left_out;
  sum.raw_occlusion.open += open - left_out;
  if (kBentNormal) sum.visible += visible;
}

#endif
