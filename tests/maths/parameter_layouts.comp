#version 460
#extension GL_GOOGLE_include_directive : require

// Declares every parameter struct in the uniform block that its shader declares it in.

#include "depth_copy_parameters.h"
#include "gtao_parameters.h"
#include "gtso_parameters.h"
#include "inspect_parameters.h"
#include "multi_bounce_parameters.h"
#include "reconstruct_parameters.h"
#include "surface_parameters.h"
#include "upsample_parameters.h"

layout(set = 0, binding = 2) uniform C { GtaoParameters gtao; };
layout(set = 0, binding = 4) uniform E { ReconstructParameters reconstruct; };
layout(set = 0, binding = 5) uniform F { GtsoParameters gtso; };
layout(set = 0, binding = 6) uniform G { MultiBounceParameters multi_bounce; };
layout(set = 0, binding = 11) uniform K { UpsampleParameters upsample; };
layout(set = 0, binding = 12) uniform L { DepthCopyParameters depth_copy; };
layout(set = 0, binding = 13) uniform M { SurfaceParameters surface; };
layout(set = 0, binding = 14) uniform N { InspectParameters inspect; };
layout(std430, set = 0, binding = 10) buffer Sum { float sum; };

void main() {
  sum = gtao.radius + reconstruct.largest_weight + gtso.roughness + multi_bounce.size_px.x +
        gtao.depth_step + upsample.tolerance + depth_copy.sky + surface.slope.x +
        float(inspect.has_motion);
}
