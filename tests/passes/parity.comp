#version 460
#extension GL_GOOGLE_include_directive : require
#include "../tests/passes/parity_case.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform writeonly image2D values;

void main() {
  imageStore(values, ivec2(gl_GlobalInvocationID.xy), parity_case(gl_GlobalInvocationID.xy));
}
