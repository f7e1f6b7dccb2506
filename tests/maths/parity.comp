#version 460
#extension GL_GOOGLE_include_directive : require

#include "parity_cases.h"

layout(local_size_x = 64) in;

layout(std140, set = 0, binding = 0) uniform Camera { Projection projection; }
camera;
layout(std430, set = 0, binding = 1) readonly buffer Inputs { vec4 numbers[]; }
inputs;
layout(std430, set = 0, binding = 2) writeonly buffer Results { vec4 values[]; }
results;
layout(push_constant) uniform Push {
  uint which;
  uint count;
}
push;

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= push.count) return;
  results.values[k] = parity_case(push.which, inputs.numbers[2u * k], inputs.numbers[2u * k + 1u],
                                  camera.projection);
}
