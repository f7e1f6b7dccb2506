// The parts of images that are read and written (AlcoveViewInfo::read_area and written_area).
// Pixels count from the corner of the area that is read. A shader that includes this file must
// define the constant kAreas, depth_image, and the members of its parameters that are named below.
// Without kAreas all images have the size of depth_image, and are read and written as a whole.
#ifndef ALCOVE_AREAS_H
#define ALCOVE_AREAS_H

// The size of the area that is read.
ivec2 size_px() { return kAreas ? parameters.area.zw : textureSize(depth_image, 0); }

// A pixel's position in the inputs.
ivec2 in_inputs(ivec2 pixel) { return kAreas ? pixel + parameters.area.xy : pixel; }

// The first pixel that is written, and the last.
ivec2 first_written() { return kAreas ? parameters.written.xy : ivec2(0); }
ivec2 last_written() { return kAreas ? parameters.written.zw : size_px() - 1; }

float fetch_depth(ivec2 pixel) { return texelFetch(depth_image, in_inputs(pixel), 0).r; }

#ifdef WRITES_OUTPUTS
// A pixel's position in the outputs, or that of a texel of 2x2 pixels.
ivec2 in_outputs(ivec2 pixel) { return kAreas ? pixel + parameters.to_outputs : pixel; }

bool is_written(ivec2 pixel) {
  return !kAreas || pixel == clamp(pixel, parameters.written.xy, parameters.written.zw);
}
#endif

#ifdef GATHERS_DEPTH
// Returns the depths around the corner between `corner - 1` and `corner`, in the order of
// textureGather. Beyond the area that is read, its border pixels are repeated. `uv` is the corner's
// position if the area is the whole image, whose sampler repeats the border.
vec4 gather_depth(ivec2 corner, vec2 uv) {
  if (!kAreas) return textureGather(sampler2D(depth_image, nearest_sampler), uv);
  ivec2 last = size_px() - 1;
  ivec2 low = clamp(corner - 1, ivec2(0), last);
  ivec2 high = clamp(corner, ivec2(0), last);
  return vec4(fetch_depth(ivec2(low.x, high.y)), fetch_depth(high),
              fetch_depth(ivec2(high.x, low.y)), fetch_depth(low));
}
#endif

#endif
