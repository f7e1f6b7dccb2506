// Reads the inverse depth of pixels from a depth buffer as the projection wrote it. A shader that
// includes this file must have the constants kPerspective and kReversed and
// parameters.inverse_depth_from_ndc.
#ifndef ALCOVE_LOAD_DEPTH_H
#define ALCOVE_LOAD_DEPTH_H

bool is_sky(float depth_ndc) { return is_sky_depth(depth_ndc, kReversed); }

float inverse_depth_of(float depth_ndc) {
  return inverse_depth_of_ndc(parameters.inverse_depth_from_ndc, depth_ndc, kPerspective,
                              kReversed);
}

#endif
