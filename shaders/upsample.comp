#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes pixels from reconstructed texels of 2x2 pixels, without blurring depth edges.
//
// A pixel is the weighted mean of the three nearest texels. A texel's weight is its barycentric
// coordinate (1/2 for the nearest, 1/4 for the others) times a function of the pixel's distance
// from the texel's tangent plane. The plane is stored with the texel (HalfTexel), so that the only
// other input of a pixel is its own depth.
//
// One invocation computes the four pixels between the centres of four texels, so that the texels
// are unpacked only once. The first invocation begins one pixel before the image.

#include "fetch_quad.h"
#include "maths/bent_normal.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "maths/raw_occlusion.h"
#include "maths/slice_line.h"
#include "upsample_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;
layout(constant_id = 1) const bool kVisibility = true;   // whether visibility_image is written
layout(constant_id = 2) const bool kShaped = false;      // power or intensity is not 1
layout(constant_id = 3) const uint kNormalEncoding = 0;  // an AlcoveNormalEncoding
layout(constant_id = 4) const bool kReversed = false;    // raw depth is 1 at the near plane
layout(constant_id = 5) const bool kAreas = false;  // images are read or written in part (areas.h)

layout(set = 0, binding = 0) uniform Parameters { UpsampleParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D half_image;        // pack_half_texel()
layout(set = 0, binding = 2) uniform texture2D half_depth_image;  // half_texel_depth()
layout(set = 0, binding = 3) uniform texture2D depth_image;       // as the projection wrote it
layout(set = 0, binding = 6) uniform writeonly image2D visibility_image;
layout(set = 0, binding = 8) uniform sampler nearest_sampler;  // it clamps to the edge
#ifdef BENT
layout(set = 0, binding = 4) uniform texture2D normal_image;    // xyz
layout(set = 0, binding = 5) uniform texture2D residual_image;  // pack_half_residual()
// In the space of the normals.
layout(set = 0, binding = 7) uniform writeonly image2D bent_normal_image;
#endif
#ifdef SPECULAR
layout(set = 0, binding = 9) uniform utexture2D lobe_image;  // LobeTexel
layout(set = 0, binding = 10) uniform writeonly image2D specular_image;
#endif

#define GATHERS_DEPTH
#define WRITES_OUTPUTS
#include "areas.h"

// Texels and pixels are numbered in the order of textureGather: lower left, lower right, upper
// right, upper left. right_of() is 1 for those on the right and -1 for the others; below_of() is 1
// for those below and -1 for the others. y points down.
float right_of(int i) { return i == 1 || i == 2 ? 1.0 : -1.0; }
float below_of(int i) { return i < 2 ? 1.0 : -1.0; }

// The largest distance from a texel's plane, in units of the tolerance, up to which weights
// decrease. The limit keeps the product of the denominators of two weights within the range of a
// float.
const float kFarthest = 1e5;

struct Cell {
  ivec2 first;      // the pixel to the upper left
  vec4 depths_ndc;  // raw depths of the pixels
  vec4 occlusions;  // of the texels
  // Coefficients of a pixel's distance from the tangent plane of each of the four texels, in units
  // of the tolerance. With d the inverse depth of the pixel (in orthographic views its linear
  // depth), the distance is steepness - plane / d in perspective views and steepness * d - plane in
  // orthographic views. `planes` holds the value `plane` of each texel for each of the four pixels.
  vec4 steepness;
  vec4 planes[4];
};

Cell fetch_cell(ivec2 index) {
  Cell cell;
  cell.first = index * 2 - 1;
  cell.depths_ndc = gather_depth(index * 2, vec2(index * 2) * parameters.pixel_uv);
  vec2 uv = vec2(index) * parameters.texel_uv;
  vec4 texel_depths = textureGather(sampler2D(half_depth_image, nearest_sampler), uv);
  cell.occlusions = textureGather(sampler2D(half_image, nearest_sampler), uv, 0);
  vec4 tilts_x = textureGather(sampler2D(half_image, nearest_sampler), uv, 2);
  vec4 tilts_y = textureGather(sampler2D(half_image, nearest_sampler), uv, 3);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    vec2 tilt = vec2(tilts_x[i], tilts_y[i]);  // in units of kLargestTilt
    // About the cosine between the normal and the view direction.
    float steepness =
        parameters.tolerance * inversesqrt(1.0 + dot(tilt, tilt) * (kLargestTilt * kLargestTilt));
    // In perspective the sky has a finite distance from a plane, but it must not count at all.
    if (kPerspective && texel_depths[i] == sky_inverse_depth(kPerspective)) steepness = kFarthest;
    float plane = steepness * texel_depths[i];
    // Over half a pixel.
    vec2 change = tilt * parameters.half_pixel_per_tilt * (kPerspective ? plane : steepness);
    // The texel's centre lies two half pixels from that of the cell.
    plane -= 2.0 * right_of(i) * change.x + 2.0 * below_of(i) * change.y;
    float left = plane - change.x;
    float right = plane + change.x;
    cell.steepness[i] = steepness;
    cell.planes[i] = vec4(left + change.y, right + change.y, right - change.y, left - change.y);
  }
  return cell;
}

// Returns the weights of the four texels for pixel `j`, which must not be sky. They have a common
// factor. Each is the barycentric coordinate / (1 + distance^2), where the distance of the pixel
// from the texel's tangent plane is in units of the tolerance. The farthest texel has the weight 0.
vec4 weights_of(Cell cell, int j) {
  float d =
      is_counted_from_zero(kPerspective, kReversed) ? cell.depths_ndc[j] : 1.0 - cell.depths_ndc[j];
  float depth = parameters.inverse_depth_from_ndc.x * d + parameters.inverse_depth_from_ndc.y;
  float scale = kPerspective ? 1.0 / depth : 1.0;
  vec4 levels;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    float off_plane = cell.steepness[i] * (kPerspective ? 1.0 : depth) - cell.planes[i][j] * scale;
    float bounded = min(abs(off_plane), kFarthest);
    levels[i] = 1.0 + bounded * bounded;
  }
  // Multiplied by the product of the denominators, so that no division is needed.
  int next = (j + 1) % 4;
  int last = (j + 3) % 4;
  vec4 weights = vec4(0.0);
  weights[j] = 2.0 * levels[next] * levels[last];
  weights[next] = levels[j] * levels[last];
  weights[last] = levels[j] * levels[next];
  return weights;
}

#ifdef BENT
#include "traced_normal.h"
#endif

void main() {
  // The cell with the first pixel that is written, and those after it.
  ivec2 index = ivec2(gl_GlobalInvocationID.xy) + (first_written() + 1) / 2;
  if (any(greaterThan(index * 2, last_written() + 1))) return;
  Cell cell = fetch_cell(index);
#ifdef BENT
  vec2 uv = vec2(index) * parameters.texel_uv;
  vec4 residuals_x = textureGather(sampler2D(residual_image, nearest_sampler), uv, 0);
  vec4 residuals_y = textureGather(sampler2D(residual_image, nearest_sampler), uv, 1);
  vec4 residuals_z = textureGather(sampler2D(residual_image, nearest_sampler), uv, 2);
#endif
#ifdef SPECULAR
  uvec4 lobes = fetch_quad(lobe_image, index);
#endif
  [[unroll]] for (int j = 0; j < 4; ++j) {
    ivec2 pixel = cell.first + ivec2(right_of(j) > 0.0 ? 1 : 0, below_of(j) > 0.0 ? 1 : 0);
    // Without areas every pixel counts: stores beyond the border of the image have no effect.
    bool inside = is_written(pixel);
    ivec2 output_pixel = in_outputs(pixel);
    vec4 weights = weights_of(cell, j);
    float inverse_sum = 1.0 / (weights.x + weights.y + weights.z + weights.w);
    bool sky = is_sky_ndc(cell.depths_ndc[j], kReversed);
    float occlusion = dot(weights, cell.occlusions) * inverse_sum;
    float visibility = sky ? 1.0 : saturate(1.0 - occlusion);
    if (kVisibility && inside) {
      float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
      imageStore(visibility_image, output_pixel, vec4(kShaped ? shaped : visibility));
    }
#ifdef BENT
    if (inside) {
      vec3 stored =
          vec3(dot(weights, residuals_x), dot(weights, residuals_y), dot(weights, residuals_z));
      vec3 residual = sky ? vec3(0.0) : unpack_half_residual(stored * inverse_sum);
      vec3 given = fetch_given_normal(pixel) * mat3(parameters.normal_from_view);
      vec3 normal = traced_normal(pixel, given, direction_to_eye(vec2(pixel) + 0.5));
      vec3 bent = finish_bent_normal(residual, visibility, normal);
      imageStore(bent_normal_image, output_pixel,
                 vec4(mat3(parameters.normal_from_view) * bent, 0.0));
    }
#endif
#ifdef SPECULAR
    if (inside) {
      vec2 sum = vec2(0.0);
      [[unroll]] for (int i = 0; i < 4; ++i) {
        LobeTexel lobe = unpack_lobe_texel(lobes[i]);
        sum += weights[i] * lobe.open * vec2(lobe.occlusion, 1.0);
      }
      float lobe_occlusion = sky ? 0.0 : saturate(sum.x / max(sum.y, 1e-37));
      imageStore(specular_image, output_pixel, vec4(1.0 - lobe_occlusion));
    }
#endif
  }
}
