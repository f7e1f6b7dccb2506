#version 460
#extension GL_GOOGLE_include_directive : require
#include "parity_case.h"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { vec4 values[]; };

void main() {
  uint k = gl_GlobalInvocationID.x;
  values[k] = parity_case(k % 4u, values[k]);
}
