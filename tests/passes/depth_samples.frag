#version 450

// Two surfaces that meet at a depth discontinuity, and tilt a little.
layout(push_constant) uniform Depths {
  float left;
  float right;
  float per_pixel;
  float edge;   // pixels
  int samples;  // that are written, as bits
};

void main() {
  gl_FragDepth = (gl_FragCoord.x < edge ? left : right) + per_pixel * gl_FragCoord.y;
  gl_SampleMask[0] = samples;
}
