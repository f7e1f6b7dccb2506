#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Spatial filter, upsampling and temporal accumulation [Jimenez 2016, sections 4.4 and 4.5] in one
// pass, because all three read the same neighbourhood with the same weights. This program
// reconstructs pixels, and reconstruct_half.comp texels of 2x2 pixels. Each has four variants, by
// the macros BENT and SPECULAR: reconstruct, reconstruct_bent, reconstruct_half_bent_specular and
// so on. A variant consists of its program and of what both programs share, in the order in which a
// texel passes through it:
//   reconstruct_bindings.h  constants, parameters and images
//   reconstruct_tiles.h     the traced pixels around a group, in shared memory
//   reconstruct_surface.h   the place and the tangent plane of a texel
//   reconstruct_previous.h  its position in the previous frame
//   reconstruct_filter.h    weighted sums over the traced pixels      section 4.4
//   reconstruct_history.h   the steps, and the sums join the history  section 4.5
//   reconstruct_store.h     residual and lobe are stored
// A program itself has what depends on the size of texels: which surface they show, in which format
// the history holds them, and what is written. passes/ALGORITHM.md, section "Sampling, filter and
// history", explains the weights.
//
// Sums hold occlusion rather than visibility: an unoccluded surface then sums zeros, and its
// visibility is exactly 1 after any number of frames.

#include "maths/history.h"
#include "reconstruct_history.h"
#include "traced_normal.h"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  load_tiles();
  reconstruct_column(last_written());
}

// --- The surface of a pixel ---

// Sets the tangent plane to that of a normal in the space of the normals.
void set_plane_of_normal(inout Surface surface, vec3 normal) {
  // `plane` is the normal of the tangent plane in the space of (x s, y s, depth): dot((x s, y s,
  // depth), plane) is constant on the plane. x and y are in pixels; s is the depth in perspective
  // and 1 otherwise.
  vec3 plane = normal * mat3(parameters.plane_from_normal);
  // How the distance from the plane grows with depth along the pixel's ray.
  float along = plane.z + (kPerspective ? dot(surface.place.centre, plane.xy) : 0.0);
  float per_length = inversesqrt(dot(normal, normal));
  surface.n_dot_v = max(abs(along) * per_length, kLeastNDotV);
  plane *= along < 0.0 ? per_length : -per_length;  // of the unit normal that faces the eye
  surface.slope = kPerspective ? -plane.xy : plane.xy;
  vec2 normal_xy = plane.xy * parameters.pixels_per_slope;
  surface.stereographic = vec3(normal_xy, 1.0 + dot(normal_xy, parameters.slope.zw) - plane.z);
  surface.lobe = fetch_lobe_surface(surface.pixel, normal);
}

// Returns Surface::stereographic for a HalfTexel::tilt.
vec3 stereographic_of_tilt(vec2 tilt, float n_dot_v) {
  vec2 xy = tilt * n_dot_v;
  return vec3(xy, 1.0 + sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

Surface fetch_surface(Place place) {
  Surface surface;
  surface.place = place;
  surface.pixel = place.texel;
  // The pixel with its neighbours to the left and above, and with those to the right and below.
  vec4 before = gather_depth(place.texel, place.uv);
  vec4 after = gather_depth(place.texel + 1, place.uv + parameters.pixel_uv);
  float depth_ndc = after.w;
  surface.sky = is_sky_ndc(depth_ndc, kReversed);
  surface.inverse_depth = inverse_depth_of(depth_ndc);
  surface.depth = kPerspective ? 1.0 / surface.inverse_depth : 1.0;
  // The plane comes from the depths where they are linear, because a normal has more bytes.
  vec2 next = vec2(after.z, after.x);
  vec2 last = vec2(before.x, before.z);
  vec2 gradient = (next - last) * (parameters.half_inverse_depth_per_ndc * surface.depth);
  vec2 tilt = gradient * parameters.pixels_per_slope * mix(1.0, -1.0, kPerspective);
  // The pixel's ray matters to angles, but hardly to the scale of distances.
  float n_dot_v = kByNormal ? n_dot_v_of(tilt, place.centre) : inversesqrt(1.0 + dot(tilt, tilt));
  surface.n_dot_v = max(n_dot_v, kLeastNDotV);
  surface.slope = gradient * n_dot_v;
  surface.stereographic = stereographic_of_tilt(tilt, n_dot_v);
  vec2 bend = abs(next + last - 2.0 * depth_ndc);
  float off_plane = (max(bend.x, bend.y) + parameters.depth_step) * surface.depth * surface.n_dot_v;
  // The comparison is true for NaN.
  if (kFresh || kLobe || !(off_plane <= parameters.largest_bend))
    set_plane_of_normal(surface, fetch_normal(surface.pixel));
  return surface;
}

// --- The outputs ---

// Stores the outputs of a pixel.
void store(Surface surface, Result result) {
  if (!is_written(surface.place.texel)) return;
  ivec2 texel = in_outputs(surface.place.texel);
  float visibility = surface.sky ? 1.0 : 1.0 - result.occlusion;
  if (kVisibility) {
    float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
    imageStore(visibility_image, texel, vec4(kShaped ? shaped : visibility));
  }
#ifdef BENT
  vec3 residual = surface.sky ? vec3(0.0) : result.residual;
  vec3 given = fetch_given_normal(surface.pixel) * mat3(parameters.normal_from_view);
  vec3 normal = traced_normal(surface.pixel, given, direction_to_eye(surface.place.centre));
  vec3 bent = finish_bent_normal(residual, visibility, normal);
  imageStore(bent_normal_image, texel, vec4(mat3(parameters.normal_from_view) * bent, 0.0));
#endif
#ifdef SPECULAR
  float occlusion = surface.sky ? 0.0 : saturate(result.lobe.x / max(result.lobe.y, 1e-30));
  imageStore(specular_image, texel, vec4(1.0 - occlusion));
#endif
}

// --- The history of pixels: HistoryTexel (maths/history.h) ---

// The logarithm of the inverse depth in perspective, the depth in orthographic views.
float log_inverse_depth(Surface surface) {
  return kPerspective ? log2(surface.inverse_depth * parameters.history_unit)
                      : surface.inverse_depth;
}

float history_slack(Surface surface) { return parameters.history_slack * surface.n_dot_v; }

// In perspective the history holds the base-2 logarithms of depths, hence 1 / ln(2).
float moved_distance(Surface surface) {
  return kDepthMotion * parameters.history_sharpness * surface.n_dot_v *
         (kPerspective ? 1.442695 * abs(parameters.history_depth_scale.z) : 1.0);
}

HistoryTexels gather_history(Surface surface, Previous previous, vec2 part, vec2 uv) {
  vec4 depths = textureGather(sampler2D(history_image, nearest_sampler), uv, 0);
  vec4 values = textureGather(sampler2D(history_image, nearest_sampler), uv, 1);
  float log_depth =
      kPerspective ? log_inverse_depth(surface) - log2(previous.depth) : previous.depth;
  float sharpness = parameters.history_sharpness * surface.n_dot_v;
  float expected = log_depth * parameters.history_depth_scale.z + parameters.history_depth_scale.w;
  // The change of a stored depth per pixel, to first order; it hardly changes from frame to frame.
  vec2 gradient = surface.slope * parameters.history_slope;
  HistoryTexels texels;
  texels.distances = depths * sharpness - gather_offsets(gradient, part, expected * sharpness);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    texels.weights[i] = texel_codes(values[i]);
    texels.occlusions[i] = fract(texels.weights[i]);
    texels.recents[i] = kMotion ? texel_recent_code(depths[i]) : 0.0;
  }
  return texels;
}

float recent_of_mean(float mean, float otherwise) { return recent_of_code(mean, otherwise); }

float occlusion_of_mean(float mean) { return texel_occlusion(mean); }

// Returns the weight for the mean of HistoryTexels::weights and the mean of the occlusions.
float mean_weight(float mean, float occlusion) { return weight_of_code(mean - occlusion); }

History fetch_history(Surface surface) {
  HistoryTexel texel = unpack_history_texel(texelFetch(history_image, surface.pixel, 0).xy);
  float expected = history_depth(parameters.history_depth_scale.xy, log_inverse_depth(surface));
  float distance = abs(texel.depth - expected) * (parameters.history_sharpness * surface.n_dot_v);
  History history = no_history();
  history.occlusion = texel.occlusion;
  history.recent = texel.recent;
  history.weight = distance <= kSameTexel + history_slack(surface) ? texel.weight : 0.0;
  return history;
}

void store_history(Surface surface, Result result, float weight, float recent) {
  float dither = dither_of(surface.place);
  float depth = history_depth(parameters.history_depth_scale.xy, log_inverse_depth(surface));
  HistoryTexel texel = HistoryTexel(depth, recent, result.occlusion, weight);
  vec2 stored = surface.sky ? vec2(0.0) : pack_history_texel(texel, dither);
  imageStore(next_history_image, surface.place.texel, vec4(stored, 0.0, 0.0));
  store_kept(surface, result, dither);
  store(surface, result);
}

void store_alone(Surface surface, Result result) { store(surface, result); }
