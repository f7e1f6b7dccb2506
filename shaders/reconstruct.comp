#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Spatial filter, upsampling and temporal accumulation [Jimenez 2016, sections 4.4 and 4.5] in one
// pass, because all three read the same neighbourhood with the same weights.
//
// A group of 8x8 invocations reconstructs a column of kBlocks blocks of 8x8 texels. It unpacks the
// traced pixels around the column into shared memory (reconstruct_tiles.h). Each invocation then
// computes one texel of each block as a weighted average of the traced pixels around it
// (reconstruct_filter.h), and continues its history (reconstruct_history.h). passes/ALGORITHM.md,
// section "Sampling, filter and history", explains the weights.
//
// Sums hold occlusion rather than visibility: an unoccluded surface then sums zeros, and its
// visibility is exactly 1 after any number of frames.

#include "reconstruct_filter.h"
#include "reconstruct_history.h"
#include "reconstruct_store.h"
#include "reconstruct_tiles.h"
#ifdef HALF
#include "reconstruct_half_surface.h"
#else
#include "reconstruct_pixel_surface.h"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

void reconstruct(Surface surface) {
  if (kHistory)
    accumulate(surface);
  else
    store_alone(surface, result_of(sum_wide(surface, Window(parameters.first_sharpness, 1.0))));
}

void main() {
  load_tiles();
  // At half resolution one texel beyond the border too, which upsampling reads.
  ivec2 last = (last_written() + (2 * kTexelSize - 2)) / kTexelSize;
  Place place = first_place();
  [[dont_unroll]] for (int block = 0; block < kBlocks; ++block) {
    if (place.texel.x <= last.x && place.texel.y <= last.y) {
      Surface surface = fetch_surface(place);
      set_plane(surface);
      reconstruct(surface);
    }
    move_to_next_block(place);
  }
}
