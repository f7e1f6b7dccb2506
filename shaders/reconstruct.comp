#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Spatial filter, upsampling and temporal accumulation [Jimenez 2016, sections 4.4 and 4.5] in one
// pass, because all three read the same neighbourhood with the same weights.
//
// One pixel of each tile of kTileSize x kTileSize pixels is traced in a frame, at a position that
// moves through the tile from frame to frame (`interleave_pixel`). A group of 8x8 invocations
// reconstructs a column of kBlocks blocks of 8x8 texels. It first unpacks the traced pixels around
// the column into shared memory. Each invocation then computes one texel of each block as a
// weighted average of the traced pixels around it. A texel with a history averages 2x2 of them. A
// texel without one averages those up to kFilterRadius tiles away on each side, except at the
// corners.
//
// The weight of a traced pixel falls with its distance on the image and with its distance from the
// pixel's tangent plane, so that a plane at any tilt is filtered as a whole and nothing leaks
// across a depth edge. Without any history it also falls with the angle between the two normals, so
// that little leaks across a crease. Weights for the GGX lobe also depend on the difference of the
// roughnesses. Occluded and unoccluded parts are summed separately and divided last.
//
// Sums hold occlusion rather than visibility: an unoccluded surface then sums zeros, and its
// visibility is exactly 1 after any number of frames.

#include "fetch_quad.h"
#include "maths/bent_normal.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "maths/lobe_slice.h"
#include "maths/normal_encoding.h"
#include "maths/projection.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "maths/slice_line.h"
#include "reconstruct_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int kTileSize = 1;
layout(constant_id = 1) const int kFilterRadius = 2;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const bool kMotion = false;
layout(constant_id = 4) const bool kPerspective = true;
layout(constant_id = 5) const bool kClamp = false;
layout(constant_id = 6) const bool kStatic = false;  // the previous frame shows the same
layout(constant_id = 7) const bool kRoughnessTexture = false;
layout(constant_id = 8) const int kRoughnessChannel = 0;
layout(constant_id = 9) const bool kFresh = true;         // there is no history to read yet
layout(constant_id = 10) const bool kVisibility = true;   // whether visibility_image is written
layout(constant_id = 11) const uint kNormalEncoding = 0;  // as NormalEncoding has them
layout(constant_id = 12) const bool kShaped = false;      // power or intensity is not 1
layout(constant_id = 13) const bool kReversed = false;    // raw depth is 1 at the near plane
// Writes visibility to the channel kVisibilityChannel alone and keeps the others.
layout(constant_id = 14) const bool kKeepsChannels = false;
layout(constant_id = 15) const int kVisibilityChannel = 0;
layout(constant_id = 16) const bool kAreas = false;  // images are read or written in part (areas.h)

#include "reconstruct_bindings.h"

// Width in pixels of the texels that are reconstructed.
#ifdef HALF
const int kTexelSize = 2;
#else
const int kTexelSize = 1;
#endif

// Whether the weight of a traced pixel falls with the angle between its normal and the pixel's. At
// half resolution such a weight raises the error by 1 %.
#ifdef HALF
const bool kByNormal = false;
#else
const bool kByNormal = (kFresh || kStatic) && kFilterRadius > 0;
#endif

// Lower bound of the cosine between the normal and the view direction. Without it, the tangent
// plane of a surface that is seen edge-on would contain points at every depth.
const float kLeastNDotV = 0.02;

#define GATHERS_DEPTH
#define WRITES_OUTPUTS
#include "areas.h"
#include "load_depth.h"

float load_inverse_depth(ivec2 pixel) { return inverse_depth_of(fetch_depth(pixel)); }

#include "depth_normal.h"
#include "reconstruct_tiles.h"

// The place of a texel, and values that depend on it alone. From block to block of a column each of
// them changes by a constant.
struct Place {
  ivec2 texel;  // at which results are stored
  vec2 centre;  // pixels
  vec2 uv;      // of the upper left corner, on the depth buffer
  TracedPixels around;
  vec4 previous;  // of an inverse depth of 0, after ReconstructParameters::previous_from_pixel
  float dither;   // for dither_of()
};

// Change of Place::dither from one pixel to the next [Jimenez 2014, interleaved gradient noise].
const vec2 kDitherGradient = vec2(0.06711056, 0.00583715);

Place first_place() {
  Place place;
  place.texel = first_texel() + ivec2(gl_LocalInvocationID.xy);
  place.centre = (vec2(place.texel) + 0.5) * float(kTexelSize);
  place.uv = vec2(place.texel * kTexelSize) * parameters.pixel_uv;
  place.around = find_traced(place.texel * kTexelSize);
  mat4 from_pixel = parameters.previous_from_pixel;
  place.previous = from_pixel[0] * place.centre.x + from_pixel[1] * place.centre.y + from_pixel[2];
  place.dither = dot(place.centre, kDitherGradient) + parameters.dither_offset;
  return place;
}

void move_to_next_block(inout Place place) {
  const float rows = float(kGroupPixels);
  place.texel.y += 8;
  place.centre.y += rows;
  place.uv.y += rows * parameters.pixel_uv.y;
  place.around.first_tile += kGroupPixels / kTileSize * kSpan;
  place.previous += parameters.previous_from_pixel[1] * rows;
  place.dither += rows * kDitherGradient.y;
}

// A pixel's surface, or that of a texel at half resolution.
struct Surface {
  Place place;
  bool sky;
  ivec2 pixel;          // at which its inputs are read
  float inverse_depth;  // 1/depth in perspective, depth otherwise: linear along any plane's image
  float depth;          // 1/inverse_depth in perspective, 1 otherwise
  float n_dot_v;        // cosine between normal and view direction, on the camera's axis
  // In perspective the relative change of 1/depth per pixel along the tangent plane, in
  // orthographic views the change of the depth, both times n_dot_v.
  vec2 slope;
  vec3 stereographic;  // (x, y, 1 + z) of the unit normal in view space, for squared_angle()
  LobeSurface lobe;    // normal as it was given
  vec2 tilt;           // HalfTexel::tilt; only with HALF
  // Coefficients of the distance of a neighbour from the tangent plane, in units of the tolerance:
  // its inverse depth times per_inverse_depth, minus plane.xy times its offset in pixels, minus
  // plane.z. They are set by set_plane().
  float per_inverse_depth;
  vec3 plane;
};

// Returns the cosine between normal and view direction, on the camera's axis, for a
// HalfTexel::tilt.
float n_dot_v_of(vec2 tilt, vec2 centre) {
  vec2 ray = parameters.slope.zw + (kPerspective ? centre * parameters.slope.xy : vec2(0.0));
  float z = 1.0 + dot(tilt, ray);
  return inversesqrt(dot(tilt, tilt) + z * z);
}

void set_plane(inout Surface surface) {
  float per_distance = surface.n_dot_v * parameters.tolerance;
  surface.per_inverse_depth = per_distance * surface.depth;
  surface.plane = vec3(surface.slope * parameters.tolerance,
                       kPerspective ? per_distance : per_distance * surface.inverse_depth);
}

// Returns the pixel's normal in the space of the normals, with any length except 0. If the texture
// has no valid normal, returns the direction to the eye instead. It is exact enough for the
// filter's weights. A NaN would stay in the history.
vec3 fetch_normal(ivec2 pixel) {
  if (kNormalEncoding == kNoNormals) {
    return depth_normal(pixel);
  }
  vec3 normal = decode_normal(texelFetch(normal_image, in_inputs(pixel), 0).xyz, kNormalEncoding);
  return has_direction(normal) ? normal : parameters.normal_from_view[2].xyz;
}

LobeSurface fetch_lobe_surface(ivec2 pixel, vec3 normal) {
  LobeSurface surface = LobeSurface(normal, parameters.roughness);
#ifdef SPECULAR
  surface.normal = normalize(normal);
  if (kRoughnessTexture) {
    surface.roughness =
        saturate(texelFetch(roughness_image, in_inputs(pixel), 0)[kRoughnessChannel]);
  }
#endif
  return surface;
}

#ifdef HALF
#include "reconstruct_half_surface.h"
#else
#include "reconstruct_surface.h"
#endif
#include "reconstruct_filter.h"
#include "reconstruct_store.h"
#ifdef HISTORY
#include "reconstruct_history.h"
#else

void reconstruct(Surface surface) {
  Sums sums = sum_wide(surface, Window(parameters.first_sharpness, 1.0));
  store_alone(surface, result_of(sums));
}

#endif

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
