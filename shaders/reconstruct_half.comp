#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// reconstruct.comp for texels of 2x2 pixels, from which upsample.comp computes the pixels.
// reconstruct.comp lists what both programs share.

#define HALF
#include "maths/half_texel.h"
#include "reconstruct_history.h"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  load_tiles();
  // One texel beyond the border too, which upsampling reads.
  reconstruct_column((last_written() + 2) / 2);
}

// --- The surface of a texel ---
// Which of its pixels represents it, and the tangent plane there, are computed from depth alone.

// The largest tilt (tangent of an angle of about 70 degrees) at which a change of depth to a
// neighbouring pixel is taken as the slope of the surface if the change on the other side of the
// pixel has the opposite sign.
const float kPlausibleTilt = 3.0;

// The pixel that represents a texel. Its inner neighbours belong to the texel too, its outer
// neighbours do not.
struct TexelPixel {
  float depth_ndc;
  vec2 inner;  // raw depths, the neighbour along x and along y
  vec2 outer;
  vec2 way;  // 1 or -1 along each axis, from the pixel to its inner neighbour
};

// Returns the change of inverse depth along an axis: the smaller one of the changes on the two
// sides of a pixel, because the larger one may lead to another surface. If the two differ in sign,
// as on a thin object, both may lead to other surfaces. A change above `plausible` is then replaced
// by 0. A change of exactly 0 is used only if both are 0, because it may come from the border of
// the image.
float gradient_of(float inner_change, float outer_change, float plausible) {
  bool inner =
      outer_change == 0.0 || (inner_change != 0.0 && abs(inner_change) < abs(outer_change));
  float smaller = inner ? inner_change : outer_change;
  bool agree = inner_change * outer_change > 0.0;
  return agree || abs(smaller) < plausible ? smaller : 0.0;
}

// Returns the pixel that represents the texel, as representative_depth() chooses it.
TexelPixel representative(Place place) {
  vec2 uv = place.uv;
  ivec2 corner = place.texel * 2;
  vec2 step = 2.0 * parameters.pixel_uv;
  // Blocks of 2x2 pixels around the corners of the texel: each has one of its pixels.
  vec4 upper_left = gather_depth(corner, uv);
  vec4 upper_right = gather_depth(corner + ivec2(2, 0), uv + vec2(step.x, 0.0));
  vec4 lower_left = gather_depth(corner + ivec2(0, 2), uv + vec2(0.0, step.y));
  vec4 lower_right = gather_depth(corner + 2, uv + step);
  // In the order of textureGather: lower left, lower right, upper right, upper left.
  vec4 inside = vec4(lower_left.z, lower_right.w, upper_right.x, upper_left.y);
  vec4 outer_x = vec4(lower_left.w, lower_right.z, upper_right.y, upper_left.x);
  vec4 outer_y = vec4(lower_left.y, lower_right.x, upper_right.w, upper_left.z);
  TexelPixel found;
  found.depth_ndc = representative_depth(place.texel, inside, kReversed);
  // At the border of the image a gather repeats the last pixels, which come first here.
  if (found.depth_ndc == inside.w) {
    found.way = vec2(1.0, 1.0);
    found.inner = inside.zx;
    found.outer = vec2(outer_x.w, outer_y.w);
  } else if (found.depth_ndc == inside.x) {
    found.way = vec2(1.0, -1.0);
    found.inner = inside.yw;
    found.outer = vec2(outer_x.x, outer_y.x);
  } else if (found.depth_ndc == inside.z) {
    found.way = vec2(-1.0, 1.0);
    found.inner = inside.wy;
    found.outer = vec2(outer_x.z, outer_y.z);
  } else {
    found.way = vec2(-1.0, -1.0);
    found.inner = inside.xz;
    found.outer = vec2(outer_x.y, outer_y.y);
  }
  return found;
}

Surface fetch_surface(Place place) {
  TexelPixel found = representative(place);
  float inverse_depth = inverse_depth_of(found.depth_ndc);
  Surface surface;
  surface.place = place;
  surface.pixel = place.texel * 2 + ivec2(found.way.x < 0.0 ? 1 : 0, found.way.y < 0.0 ? 1 : 0);
  // The texel beyond the border has none of its own.
  surface.pixel = min(surface.pixel, size_px() - 1);
  surface.sky = is_sky_ndc(found.depth_ndc, kReversed);
  float scale = kPerspective ? inverse_depth : 1.0;
  // The change of inverse depth per unit of raw depth.
  float per_ndc = is_counted_from_zero(kPerspective, kReversed)
                      ? parameters.inverse_depth_from_ndc.x
                      : -parameters.inverse_depth_from_ndc.x;
  vec2 to_inner = (found.inner - found.depth_ndc) * (found.way * per_ndc);
  vec2 from_outer = (found.depth_ndc - found.outer) * (found.way * per_ndc);
  vec2 plausible = kPlausibleTilt * scale * abs(parameters.slope.xy);
  vec2 gradient = vec2(gradient_of(to_inner.x, from_outer.x, plausible.x),
                       gradient_of(to_inner.y, from_outer.y, plausible.y));
  float inverse_scale = 1.0 / scale;
  surface.tilt =
      gradient * parameters.pixels_per_slope * (kPerspective ? -inverse_scale : inverse_scale);
  surface.n_dot_v = max(n_dot_v_of(surface.tilt, place.centre), kLeastNDotV);
  // The plane at the texel's centre, bounded where it is seen edge-on.
  float moved = inverse_depth + 0.5 * dot(found.way, gradient);
  surface.inverse_depth =
      kPerspective ? clamp(moved, 0.5 * inverse_depth, 2.0 * inverse_depth) : moved;
  surface.depth = kPerspective ? 1.0 / surface.inverse_depth : 1.0;
  surface.slope = gradient * (surface.depth * surface.n_dot_v);
  if (kLobe) surface.lobe = fetch_lobe_surface(surface.pixel, fetch_normal(surface.pixel));
  return surface;
}

// --- The history of texels: HalfTexel (maths/half_texel.h) ---
// The previous frame stored it for upsampling.

// Stores a texel for upsampling and for the next frame. `recent`, the occlusion of the last few
// frames, is stored only with kMotion.
void store_half(Surface surface, Result result, float weight, float recent) {
  HalfTexel texel = HalfTexel(result.occlusion, weight, surface.tilt);
  imageStore(half_image, surface.place.texel, surface.sky ? vec4(0.0) : pack_half_texel(texel));
  float depth = surface.sky ? sky_inverse_depth(kPerspective)
                            : half_texel_depth(surface.inverse_depth, recent, kMotion);
  imageStore(half_depth_image, surface.place.texel, vec4(depth));
}

float history_slack(Surface surface) { return parameters.history_slack; }

float moved_distance(Surface surface) {
  return kDepthMotion * parameters.history_sharpness * surface.n_dot_v *
         (kPerspective ? 1.0 : 1.0 / parameters.history_depth_scale.z);
}

HistoryTexels gather_history(Surface surface, Previous previous, vec2 part, vec2 uv) {
  vec4 depths = textureGather(sampler2D(history_depth_image, nearest_sampler), uv);
  float sharpness = parameters.history_sharpness * surface.n_dot_v;
  float per_depth = kPerspective ? previous.depth * surface.depth : 1.0;
  float expected = kPerspective ? 1.0 : previous.depth;
  // The slope hardly changes from frame to frame, but for the scale of all depths.
  vec2 gradient = surface.slope * (parameters.history_sharpness * float(kTexelSize));
  HistoryTexels texels;
  texels.distances =
      depths * (per_depth * sharpness) - gather_offsets(gradient, part, expected * sharpness);
  texels.occlusions = textureGather(sampler2D(history_image, nearest_sampler), uv, 0);
  texels.weights = textureGather(sampler2D(history_image, nearest_sampler), uv, 1);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    texels.recents[i] = kMotion ? half_texel_recent_code(depths[i]) : 0.0;
  }
  return texels;
}

float recent_of_mean(float mean, float otherwise) { return half_recent_of_code(mean, otherwise); }

float occlusion_of_mean(float mean) { return mean; }

// Returns the weight for the mean of HistoryTexels::weights.
float mean_weight(float mean, float /*occlusion*/) { return mean * kHalfTexelWeightUnit; }

History fetch_history(Surface surface) {
  float depth = texelFetch(history_depth_image, surface.place.texel, 0).r;
  vec4 stored = texelFetch(history_image, surface.place.texel, 0);
  float distance = abs(depth - surface.inverse_depth) *
                   (surface.depth * parameters.history_sharpness * surface.n_dot_v);
  History history = no_history();
  history.occlusion = stored.x;
  history.recent = half_recent_of_code(half_texel_recent_code(depth), stored.x);
  history.weight =
      distance <= kSameTexel + history_slack(surface) ? stored.y * kHalfTexelWeightUnit : 0.0;
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  store_half(surface, result, weight, recent);
  store_kept(surface, result, dither_of(surface.place));
}

void store_alone(Surface surface, Result result) {
  store_half(surface, result, 0.0, 0.0);
  store_kept(surface, result, 0.5);
}
