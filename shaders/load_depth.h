// The inverse depth of pixels of a depth buffer as the projection wrote it. Included by shaders that
// have the constants kPerspective and kReversed and parameters.inverse_depth_from_ndc.
#ifndef ALCOVE_LOAD_DEPTH_H
#define ALCOVE_LOAD_DEPTH_H

float inverse_depth_of(float depth_ndc) {
  return inverse_depth_of_ndc(parameters.inverse_depth_from_ndc, depth_ndc, kPerspective,
                              kReversed);
}

vec4 inverse_depths_of(vec4 depths_ndc) {
  return vec4(inverse_depth_of(depths_ndc.x), inverse_depth_of(depths_ndc.y),
              inverse_depth_of(depths_ndc.z), inverse_depth_of(depths_ndc.w));
}

#endif
