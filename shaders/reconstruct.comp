#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// From searched pixels to every pixel: the memo's spatial filter, the upsampling of a search at lower
// resolution, and (compiled with HISTORY) accumulation over frames. They read the same neighbourhood
// with the same weights, so they are one pass, and what is off is not compiled in.
//
// A block of kDivisor x kDivisor pixels has one search a frame, of a pixel that moves through the
// block from frame to frame: every pixel is searched at its own depth in time, and edges come back
// sharp. Neighbours weigh by their distance on the image, in a window that narrows as a pixel gathers
// frames, and by their distance from the pixel's tangent plane, so that a plane at any tilt is
// filtered whole and nothing leaks across an edge. Sums are added up, visible and open parts each,
// and divided last.

#include "maths/bent_normal.h"
#include "maths/gtao.h"
#include "maths/history.h"
#include "maths/projection.h"
#include "maths/reprojection.h"
#include "maths/slice_line.h"
#include "reconstruct_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int kDivisor = 1;
layout(constant_id = 1) const int kReach = 2;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const bool kMotion = false;

layout(set = 0, binding = 0) uniform Parameters { ReconstructParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D signal_image;  // visible, open; one texel a block
layout(set = 0, binding = 2) uniform texture2D bent_image;    // where there is none, the signal
layout(set = 0, binding = 3) uniform texture2D depth_image;   // linear, every pixel
layout(set = 0, binding = 4) uniform texture2D normal_image;  // xyz, turned by view_from_normal
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals; bound to the visibility and never written where there is none.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
#ifdef HISTORY
layout(set = 0, binding = 7) uniform texture2D motion_image;  // where there is none, the depth
layout(set = 0, binding = 8) uniform utexture2D history_image;
layout(set = 0, binding = 9) uniform texture2D bent_history_image;
layout(set = 0, binding = 10) uniform writeonly uimage2D next_history_image;
layout(set = 0, binding = 11) uniform writeonly image2D next_bent_history_image;
#endif

struct Surface {
  ivec2 pixel;
  vec2 uv;
  float depth;
  vec3 position;  // view space
  vec3 normal;    // unit, view space
  // Distance to the tangent plane as a linear form: a neighbour at offset (i, j) and depth z lies
  // s * (i * plane_per_px.x + j * plane_per_px.y) + (z - depth) * plane_per_depth from it, in
  // tolerances.
  vec2 plane_per_px;
  float plane_per_depth;
};

// What is added up: over neighbours, then over frames.
struct Sum {
  vec2 signal;
  vec3 bent;
};

struct Neighbourhood {
  Sum sum;
  float weight;
  Spread spread;  // of the visibility
};

Surface fetch_surface(ivec2 pixel, float depth) {
  Projection projection = parameters.projection;
  Surface surface;
  surface.pixel = pixel;
  surface.uv = pixel_centre_uv(projection, uvec2(pixel));
  surface.depth = depth;
  surface.position = position_vs(projection, surface.uv, depth);
  surface.normal =
      normalize(mat3(parameters.view_from_normal) * texelFetch(normal_image, pixel, 0).xyz);
  vec2 per_px = ray_per_px(projection);
  float tolerance =
      parameters.tolerance_px * abs(per_px.y) * sample_scale(projection, depth);
  vec3 ray = position_vs(projection, surface.uv, 1.0) - position_vs(projection, surface.uv, 0.0);
  surface.plane_per_px = per_px * surface.normal.xy / tolerance;
  surface.plane_per_depth = dot(surface.normal, ray) / tolerance;
  return surface;
}

float plane_distance_weight(Surface surface, vec2 offset, float depth) {
  float distance = sample_scale(parameters.projection, depth) * dot(offset, surface.plane_per_px) +
                   (depth - surface.depth) * surface.plane_per_depth;
  return max(1.0 - abs(distance), 0.0);
}

Sum fetch_sum(ivec2 block, float weight) {
  Sum sum;
  sum.signal = weight * texelFetch(signal_image, block, 0).rg;
  sum.bent = kBentNormal ? weight * texelFetch(bent_image, block, 0).xyz : vec3(0.0);
  return sum;
}

// The searches of the blocks around a pixel. `narrowness` is 1 / (2 width^2), width in pixels.
Neighbourhood gather(Surface surface, int reach, float narrowness) {
  ivec2 size = ivec2(parameters.projection.size_px);
  ivec2 last_block = (size + kDivisor - 1) / kDivisor - 1;
  ivec2 centre = surface.pixel / kDivisor;
  ivec2 phase = ivec2(parameters.phase);
  ivec2 low = max(centre - reach, ivec2(0));
  ivec2 high = min(centre + reach, last_block);

  Neighbourhood found;
  found.sum.signal = vec2(0.0);
  found.sum.bent = vec3(0.0);
  found.weight = 0.0;
  float squares = 0.0;
  float plain = 0.0;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      ivec2 searched = min(ivec2(x, y) * kDivisor + phase, size - 1);
      vec2 offset = vec2(searched - surface.pixel);
      float depth = texelFetch(depth_image, searched, 0).r;
      // A little everywhere: where no neighbour lies on the plane their plain mean is all there is.
      float weight = exp(-dot(offset, offset) * narrowness) *
                     max(plane_distance_weight(surface, offset, depth), 1e-4);
      Sum more = fetch_sum(ivec2(x, y), weight);
      found.sum.signal += more.signal;
      found.sum.bent += more.bent;
      found.weight += weight;
#ifdef HISTORY
      float visibility = more.signal.x / max(more.signal.y, 1e-9);
      plain += weight * visibility;
      squares += weight * visibility * visibility;
#endif
    }
  }
  found.spread = spread_of_sums(plain / found.weight, squares / found.weight, 1.0);
  return found;
}

void store(ivec2 pixel, Sum sum) {
  float visibility = mean_visibility(sum.signal.x, sum.signal.y);
  imageStore(visibility_image, pixel, vec4(visibility));
  if (kBentNormal) {
    mat3 normal_from_view = transpose(mat3(parameters.view_from_normal));
    vec3 fallback = texelFetch(normal_image, pixel, 0).xyz;
    vec3 bent = finish_bent_normal(normal_from_view * sum.bent, fallback);
    imageStore(bent_normal_image, pixel, vec4(bent, 0.0));
  }
}

#ifdef HISTORY

// What a pixel has gathered so far.
struct History {
  Sum sum;      // weighted means over frames
  float count;  // frames; 0 where nothing of this surface is known
};

// Means in 16 bits each, depth as a half, and the count: 8 bytes a pixel. Rounding is to nearest, and
// finer than the noise by far, so that means neither drift nor lock.
const float kLargestMean = 8.0;  // of a window's weights (below 4) times an open slice (below pi/2)

uvec2 pack_history(History history, float depth) {
  return uvec2(packUnorm2x16(history.sum.signal / kLargestMean),
               packHalf2x16(vec2(min(depth, 6e4), history.count)));
}

const float kDepthTolerance = 0.01;  // of the depth, for a surface seen head-on

History read_history(Surface surface) {
  History history;
  history.sum.signal = vec2(0.0);
  history.sum.bent = vec3(0.0);
  history.count = 0.0;
  Reprojected before =
      reproject_camera(parameters.previous, parameters.previous_view_from_view, surface.position);
  if (kMotion) {
    vec2 motion = texelFetch(motion_image, surface.pixel, 0).rg;
    before = reproject_motion(parameters.previous, parameters.previous_view_from_view,
                              surface.position, surface.uv, motion);
  }
  if (parameters.history_valid == 0u || before.valid == 0.0) {
    return history;
  }
  ivec2 last = ivec2(parameters.projection.size_px) - 1;
  BilinearTaps taps = bilinear_taps(before.uv, parameters.projection.size_px);
  vec3 view = view_vector(parameters.projection, surface.position);
  float slant = dot(surface.normal, view);
  float weight_sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    float weight = taps.weights[i];
    // Where nothing moves three of the four weigh next to nothing and are not read.
    if (weight > 0.01) {
      ivec2 texel = clamp(ivec2(taps.first) + ivec2(i & 1, i >> 1), ivec2(0), last);
      uvec2 stored = texelFetch(history_image, texel, 0).xy;
      vec2 depth_and_count = unpackHalf2x16(stored.y);
      weight *= history_weight(min(before.depth, 6e4), depth_and_count.x, kDepthTolerance, slant);
      history.sum.signal += weight * kLargestMean * unpackUnorm2x16(stored.x);
      if (kBentNormal) {
        history.sum.bent += weight * texelFetch(bent_history_image, texel, 0).xyz;
      }
      history.count += weight * depth_and_count.y;
      weight_sum += weight;
    }
  }
  if (weight_sum < 0.05) {
    history.count = 0.0;
    return history;
  }
  float scale = 1.0 / weight_sum;
  history.sum.signal *= scale;
  history.sum.bent *= scale;
  history.count *= scale;
  return history;
}

// The pixel's sums with this frame's neighbourhood added.
History advance(Surface surface, History history) {
  // Wide while a pixel has little of its own, then hardly more than the pixel itself.
  float width = max(0.8, 2.0 * inversesqrt(history.count + 1.0));
  Neighbourhood now =
      gather(surface, history.count < 8.0 ? kReach : 1, 0.5 / (width * width));
  // Not divided by the weight found: a frame that searched the pixel itself counts for more than one
  // that searched its neighbours. Divided by the window's size, so that wide ones do not.
  float scale = 0.64 / (width * width);
  History next;
  if (history.count > 0.0 && parameters.clamp_width > 0.0) {
    float before = mean_visibility(history.sum.signal.x, history.sum.signal.y);
    float after = clamp_to_spread(before, now.spread, parameters.clamp_width);
    history.sum.signal.x = after * history.sum.signal.y;
    history.count = count_after_clamp(history.count, before, after, 0.25);
  }
  float weight = accumulation_weight(history.count, parameters.longest);
  next.sum.signal = mix(history.sum.signal, now.sum.signal * scale, weight);
  next.sum.bent = mix(history.sum.bent, now.sum.bent * scale, weight);
  next.count = next_count(history.count, parameters.longest);
  return next;
}

void reconstruct(Surface surface) {
  History next = advance(surface, read_history(surface));
  imageStore(next_history_image, surface.pixel,
             uvec4(pack_history(next, surface.depth), 0u, 0u));
  if (kBentNormal) {
    imageStore(next_bent_history_image, surface.pixel, vec4(next.sum.bent, 0.0));
  }
  store(surface.pixel, next.sum);
}

#else

void reconstruct(Surface surface) {
  float width = float(kDivisor) * (kReach > 1 ? 1.5 : 1.0);
  store(surface.pixel, gather(surface, kReach, 0.5 / (width * width)).sum);
}

#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(parameters.projection.size_px)))) {
    return;
  }
  float depth = texelFetch(depth_image, pixel, 0).r;
  if (is_sky_depth(depth)) {
    Sum open;
    open.signal = vec2(1.0);
    open.bent = vec3(0.0);
    store(pixel, open);
#ifdef HISTORY
    imageStore(next_history_image, pixel, uvec4(0u));
#endif
    return;
  }
  reconstruct(fetch_surface(pixel, depth));
}
