#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Spatial filter, upsampling and temporal accumulation [Jimenez 2016, sections 4.4 and 4.5] in one
// pass, because all three read the same neighbourhood with the same weights.
//
// One pixel of each tile of kTileSize x kTileSize pixels is traced in a frame, at a position that
// moves through the tile from frame to frame (`interleave_offset`). Each invocation computes one
// pixel. A group of 8x8 adjacent pixels first unpacks the traced pixels around it into shared
// memory. A pixel then averages the traced pixels around it: 2x2 of them where it has a history,
// kFilterRadius on each side, without the corners, where it has none. Their weights fall with the
// distance on the image, with the distance from the pixel's tangent plane, so that a plane at any
// tilt is filtered as a whole and nothing leaks across a depth edge, and with the angle between the
// normals, so that little leaks across a crease. Occluded and open parts are summed separately and
// divided last. Sums of the GGX lobe are also weighted by how alike normals and roughnesses are.
//
// Sums hold occlusion rather than visibility: an unoccluded surface then sums zeros, and its
// visibility is exactly 1 after any number of frames.

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

#ifdef SPECULAR
const bool kLobe = true;
#define RAW_FORMAT rgba32ui
#else
const bool kLobe = false;
#define RAW_FORMAT rg32ui
#endif

#ifdef HALF
#define BENT_HISTORY_SAMPLER sampler2D
#define BENT_HISTORY_IMAGE image2D
#else
#define BENT_HISTORY_SAMPLER usampler2D
#define BENT_HISTORY_IMAGE uimage2D
#endif

layout(set = 0, binding = 0) uniform Parameters { ReconstructParameters parameters; };
layout(set = 0, binding = 1, RAW_FORMAT) uniform readonly uimage2D raw_image;  // one texel a tile
// Without bent normals it is never read, and another image is bound in its place.
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D bent_image;
layout(set = 0, binding = 4) uniform texture2D normal_image;  // xyz
#ifdef HALF
// The depth buffer as the projection wrote it. Its sampler is nearest and clamps to the edge.
layout(set = 0, binding = 3) uniform sampler2D depth_image;
layout(set = 0, binding = 5) uniform writeonly image2D half_image;        // pack_half_texel()
layout(set = 0, binding = 6) uniform writeonly image2D half_depth_image;  // half_texel_depth()
const int kFirstHistoryBinding = 7;
#else
layout(set = 0, binding = 3) uniform texture2D depth_image;  // the depth buffer
// If an output is not wanted, it is never written, and another image is bound in its place.
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
const int kFirstHistoryBinding = 7;
// The image that visibility_image writes, from which the kept channels are read. Without
// kKeepsChannels it is never read, and another image is bound in its place.
layout(set = 0, binding = 16) uniform texture2D kept_image;
#endif
#ifdef HISTORY
// The samplers are nearest and clamp to the edge.
#ifdef HALF
// half_image and half_depth_image of the previous frame.
layout(set = 0, binding = kFirstHistoryBinding) uniform sampler2D history_image;
layout(set = 0, binding = kFirstHistoryBinding + 1) uniform sampler2D history_depth_image;
#else
layout(set = 0, binding = kFirstHistoryBinding) uniform usampler2D history_image;  // HistoryTexel
layout(set = 0, binding = kFirstHistoryBinding + 1) uniform writeonly uimage2D next_history_image;
#endif
// Without kMotion it is never read, and another image is bound in its place.
layout(set = 0, binding = kFirstHistoryBinding + 2) uniform texture2D motion_image;
// Bent-normal residuals: pack_residual(), at half resolution pack_half_residual(). Without bent
// normals they are never accessed, and other images are bound in their place.
layout(set = 0, binding = kFirstHistoryBinding + 3) uniform BENT_HISTORY_SAMPLER bent_history_image;
layout(set = 0, binding = kFirstHistoryBinding +
                          4) uniform writeonly BENT_HISTORY_IMAGE next_bent_history_image;
const int kFirstLobeBinding = kFirstHistoryBinding + 5;
#elif defined(HALF)
// The upsampling pass reads residuals and lobes in the formats of the history.
layout(set = 0,
       binding = kFirstHistoryBinding) uniform writeonly BENT_HISTORY_IMAGE next_bent_history_image;
const int kFirstLobeBinding = kFirstHistoryBinding + 1;
#else
const int kFirstLobeBinding = kFirstHistoryBinding;
#endif
#ifdef SPECULAR
layout(set = 0, binding = kFirstLobeBinding) uniform texture2D roughness_image;  // perceptual
#ifdef HALF
const int kFirstLobeHistoryBinding = kFirstLobeBinding + 1;
#else
layout(set = 0, binding = kFirstLobeBinding + 1) uniform writeonly image2D specular_image;
const int kFirstLobeHistoryBinding = kFirstLobeBinding + 2;
#endif
#ifdef HISTORY
// LobeTexel.
layout(set = 0, binding = kFirstLobeHistoryBinding) uniform usampler2D lobe_history_image;
layout(set = 0,
       binding = kFirstLobeHistoryBinding + 1) uniform writeonly uimage2D next_lobe_history_image;
#elif defined(HALF)
layout(set = 0,
       binding = kFirstLobeHistoryBinding) uniform writeonly uimage2D next_lobe_history_image;
#endif
#endif

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
const bool kByNormal = true;
#endif

// Whether a pixel averages the traced pixels around it. If not, every pixel was traced itself, or
// takes the value of its tile.
const bool kBetween = kTileSize > 1 && kFilterRadius > 0;
// Number of traced pixels on each side that are averaged for a pixel with a history.
const int kNearRadius = kFilterRadius == 0 ? 0 : 1;
// Number of tiles along x and along y whose traced pixels the pixels of a group average.
const int kSpan = 8 * kTexelSize / kTileSize + 2 * kFilterRadius;
// Base-2 logarithm of kTileSize.
const int kShift = kTileSize == 8 ? 3 : kTileSize == 4 ? 2 : kTileSize == 2 ? 1 : 0;

// The unpacked raw occlusion of the tiles around the group.
// x: inverse depth. y: the occluded part, z: RawOcclusion::open, neither of them normalised. w: x
// of the normal's stereographic projection.
shared vec4 traced[kSpan * kSpan];
shared float traced_stereographic_y[kByNormal ? kSpan * kSpan : 1];
// The arrays of results that are not computed have one element, which nothing reads.
const int kBentSpan = kBentNormal ? kSpan * kSpan : 1;
shared vec4 traced_residual[kBentSpan];           // residual, expected residual x
shared vec2 traced_expected_residual[kBentSpan];  // yz
const int kLobeSpan = kLobe ? kSpan * kSpan : 1;
shared vec2 traced_lobe[kLobeSpan];  // occluded, open
shared uint traced_lobe_surface[kLobeSpan];

struct Surface {
  bool sky;
  ivec2 texel;          // texel of the history at which its results are stored
  ivec2 pixel;          // pixel at which its inputs are read
  vec2 centre;          // centre of the texel, pixels
  float inverse_depth;  // 1/depth in perspective, depth otherwise: linear along any plane's image
  vec2 gradient;        // of inverse_depth on the tangent plane, per pixel
  float plane_weight;   // tolerances per unit of inverse_depth off the tangent plane
  float n_dot_v;        // cosine between normal and view direction, on the camera's axis
  QuantisedNormal quantised;
  LobeSurface lobe;   // normal as it was given
  vec2 tilt;          // HalfTexel::tilt; only with HALF
  float depth;        // about 1/inverse_depth in perspective; only with HALF
  int first_tile;     // index in `traced` of the tile to the upper left
  vec2 offset;        // to the pixel that was traced there, pixels, before clamping to the image
  vec4 traced_range;  // smallest and largest offset of a traced pixel in the image
};

ivec2 size_px() { return textureSize(depth_image, 0); }

ivec2 last_tile() { return (size_px() + (kTileSize - 1)) / kTileSize - 1; }

#include "load_depth.h"

#ifndef HALF
float load_inverse_depth(ivec2 pixel) {
  return inverse_depth_of(texelFetch(depth_image, pixel, 0).r);
}

#include "depth_normal.h"
#endif

// Returns the pixel's normal in the space of the normals; its length may be any but 0. If the
// texture has no valid normal, returns the direction to the eye: that is exact enough for the
// filter's weights, and a NaN would stay in the history.
vec3 fetch_normal(ivec2 pixel) {
  vec3 normal = decode_normal(texelFetch(normal_image, pixel, 0).xyz, kNormalEncoding);
  return has_direction(normal) ? normal : parameters.normal_from_view[2].xyz;
}

LobeSurface fetch_lobe_surface(ivec2 pixel, vec3 normal) {
  LobeSurface surface = LobeSurface(normal, parameters.roughness);
#ifdef SPECULAR
  surface.normal = normalize(normal);
  if (kRoughnessTexture) {
    surface.roughness = saturate(texelFetch(roughness_image, pixel, 0)[kRoughnessChannel]);
  }
#endif
  return surface;
}

// Returns the tile to the upper left among the 2x2 tiles whose traced pixels surround a pixel. If
// pixels take the value of their tile, returns the pixel's own tile.
ivec2 cell_of(ivec2 pixel) {
  return kBetween ? (pixel - parameters.interleave_pixel) >> kShift : pixel >> kShift;
}

// Returns the offset from a pixel to the traced pixel of the tile cell_of(pixel), in pixels.
vec2 offset_of_traced(ivec2 pixel) {
  return kBetween ? -vec2((pixel - parameters.interleave_pixel) & (kTileSize - 1))
                  : parameters.interleave_offset - vec2(pixel & (kTileSize - 1));
}

// Returns the tile to the upper left of all tiles that the group averages.
ivec2 first_tile_of_group() {
  ivec2 cell = cell_of(ivec2(gl_WorkGroupID.xy) * (8 * kTexelSize));
  return cell - (kBetween ? kFilterRadius - 1 : kFilterRadius);
}

void load_tile(ivec2 first, ivec2 place) {
  ivec2 tile = clamp(first + place, ivec2(0), last_tile());
  int i = place.y * kSpan + place.x;
  uvec4 stored = imageLoad(raw_image, tile);
  RawOcclusion raw = unpack_raw_occlusion(stored.x);
  vec2 stereographic = stereographic_of_bits(raw_occlusion_normal(stored.x));
  traced[i] = vec4(uintBitsToFloat(stored.y), raw.open - raw.visible, raw.open, stereographic.x);
  if (kByNormal) {
    traced_stereographic_y[i] = stereographic.y;
  }
  if (kBentNormal) {
    uvec2 bent = imageLoad(bent_image, tile).xy;
    vec3 expected = unpack_residual(bent.y);
    traced_residual[i] = vec4(unpack_residual(bent.x), expected.x);
    traced_expected_residual[i] = expected.yz;
  }
  if (kLobe) {
    RawOcclusion lobe = unpack_lobe(stored.z);
    traced_lobe[i] = vec2(lobe.open - lobe.visible, lobe.open);
    traced_lobe_surface[i] = stored.w;
  }
}

void load_tiles() {
  ivec2 first = first_tile_of_group();
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  [[unroll]] for (int y = 0; y < kSpan; y += 8) {
    [[unroll]] for (int x = 0; x < kSpan; x += 8) {
      ivec2 place = local + ivec2(x, y);
      if (all(lessThan(place, ivec2(kSpan)))) {
        load_tile(first, place);
      }
    }
  }
  barrier();
}

// Sets the members of `surface` that locate the traced pixels around its centre.
void find_traced(inout Surface surface) {
  ivec2 pixel = surface.texel * kTexelSize;
  ivec2 place = cell_of(pixel) - first_tile_of_group();
  surface.first_tile = place.y * kSpan + place.x;
  surface.offset = offset_of_traced(pixel) - 0.5 * float(kTexelSize - 1);
  surface.traced_range = parameters.traced_range - (surface.centre - 0.5).xyxy;
}

// Bound of the cosine between normal and view direction: a plane seen edge-on would reach any
// depth.
const float kLeastNDotV = 0.02;

#ifdef HALF
#include "reconstruct_half_surface.h"
#else

Surface fetch_surface(ivec2 pixel) {
  Surface surface;
  surface.texel = surface.pixel = pixel;
  surface.centre = vec2(pixel) + 0.5;
  surface.inverse_depth = load_inverse_depth(pixel);
  surface.sky = surface.inverse_depth == sky_inverse_depth(kPerspective);
  vec3 given = fetch_normal(pixel);
  vec3 normal = normalize(given * mat3(parameters.normal_from_view));
  // dot((x s, y s, depth), plane) is constant on the tangent plane, where x and y are in pixels and
  // s is the depth in perspective and 1 otherwise.
  vec3 plane =
      vec3(normal.xy * parameters.slope.xy, dot(normal.xy, parameters.slope.zw) - normal.z);
  // How the distance from the plane grows with depth along the pixel's ray.
  float along = plane.z + (kPerspective ? dot(surface.centre, plane.xy) : 0.0);
  surface.n_dot_v = max(abs(along), kLeastNDotV);
  float facing = along < 0.0 ? 1.0 : -1.0;
  float per_unit = facing / surface.n_dot_v;
  surface.gradient = plane.xy * (kPerspective ? -surface.inverse_depth * per_unit : per_unit);
  surface.plane_weight =
      surface.n_dot_v * parameters.tolerance * (kPerspective ? 1.0 / surface.inverse_depth : 1.0);
  surface.quantised = make_quantised_normal(normal * facing);
  surface.lobe = fetch_lobe_surface(pixel, given);
  find_traced(surface);
  return surface;
}

#endif

// Weighted sums over traced pixels.
struct Sums {
  float occluded;
  float open;
  vec3 residual;
  vec3 expected_residual;
  vec2 lobe;     // occluded, open
  vec3 moments;  // of the visibility
};

Sums no_sums() { return Sums(0.0, 0.0, vec3(0.0), vec3(0.0), vec2(0.0), vec3(0.0)); }

// Bound of the squared angle between normals in a neighbour's weight, which is then at least
// 1 / (1 + 1.23)^2 = 0.2: where a pixel has few other neighbours, one across a crease is better
// than none. Fitted to the error of first frames (`alcove compare --frames 1`).
const float kLargestSquaredAngle = 1.23;

// Returns the offset from the surface's centre to the traced pixel that lies `i` tiles to the right
// of (axis 0) or below (axis 1) the surface's first, pixels.
float traced_offset(Surface surface, int axis, int i) {
  return clamp(surface.offset[axis] + float(i * kTileSize), surface.traced_range[axis],
               surface.traced_range[axis + 2]);
}

// Adds the traced pixel at `offset` pixels. Its weight falls with the distance on the image, with
// the distance from the tangent plane and with the angle between the normals, but never to zero:
// where no neighbour lies on the plane, the nearest to it count.
void add_traced(inout Sums sums, Surface surface, float inverse_squared_width, int i, int j) {
  vec2 offset = vec2(traced_offset(surface, 0, i), traced_offset(surface, 1, j));
  int index = surface.first_tile + j * kSpan + i;
  vec4 found = traced[index];
  float off_plane = (found.x - (surface.inverse_depth + offset.x * surface.gradient.x +
                                offset.y * surface.gradient.y)) *
                    surface.plane_weight;
  float near = 1.0 + offset.x * offset.x * inverse_squared_width +
               offset.y * offset.y * inverse_squared_width;
  float level = 1.0 + min(off_plane * off_plane, 1e14);  // the weight is no denormal
  if (kByNormal) {
    level += min(squared_turn(surface.quantised, vec2(found.w, traced_stereographic_y[index])),
                 kLargestSquaredAngle);
  }
  float both = near * near * level;
  float weight = 1.0 / (both * both);
  sums.occluded += weight * found.y;
  sums.open += weight * found.z;
  if (kBentNormal) {
    vec4 residual = traced_residual[index];
    sums.residual += weight * residual.xyz;
    sums.expected_residual += weight * vec3(residual.w, traced_expected_residual[index]);
  }
  if (kLobe) {
    sums.lobe +=
        weight * lobe_weight(surface.lobe, traced_lobe_surface[index]) * traced_lobe[index];
  }
  if (kClamp) {
    float visibility = 1.0 - found.y / max(found.z, 1e-9);
    sums.moments += weight * vec3(1.0, visibility, visibility * visibility);
  }
}

// Returns the sums over the traced pixels within kNearRadius.
Sums sum_near(Surface surface, float inverse_squared_width) {
  Sums sums = no_sums();
  const int first = kBetween ? 0 : -kNearRadius;
  [[unroll]] for (int j = first; j <= kNearRadius; ++j) {
    [[unroll]] for (int i = first; i <= kNearRadius; ++i) {
      add_traced(sums, surface, inverse_squared_width, i, j);
    }
  }
  return sums;
}

// The traced pixels of radius kFilterRadius without the corners, except those nearer than `inner`
// on both axes.
void add_ring(inout Sums sums, Surface surface, float inverse_squared_width, int inner) {
  const int first = kBetween ? 1 - kFilterRadius : -kFilterRadius;
  const int inner_first = kBetween ? 1 - inner : -inner;
  [[dont_unroll]] for (int j = first; j <= kFilterRadius; ++j) {
    bool edge = kFilterRadius > 1 && (j == first || j == kFilterRadius);
    bool inside = inner > 0 && j >= inner_first && j <= inner;
    int i = edge ? first + 1 : first;
    int last = edge ? kFilterRadius - 1 : kFilterRadius;
    [[dont_unroll]] while (i <= last) {
      add_traced(sums, surface, inverse_squared_width, i, j);
      i += inside && i == inner_first - 1 ? inner + 1 - i : 1;
    }
  }
}

#ifndef HALF

#include "store_visibility.h"

// Returns the unit normal in view space, as the search uses it.
vec3 traced_normal(Surface surface) {
  vec2 slope =
      parameters.slope.zw + (kPerspective ? surface.centre * parameters.slope.xy : vec2(0.0));
  vec3 given = decode_normal(texelFetch(normal_image, surface.pixel, 0).xyz, kNormalEncoding) *
               mat3(parameters.normal_from_view);
  return seen_normal(surface.pixel, given, normalize(vec3(-slope, 1.0)));
}

#endif

// The results of a texel.
struct Result {
  float occlusion;
  vec3 residual;
  vec2 lobe;  // occluded, open
};

// A number in [0,1) that is evenly distributed over neighbouring texels and over frames:
// interleaved gradient noise [Jimenez 2014].
float dither_of(ivec2 texel) {
  return fract(52.9829189 *
               fract(dot(vec2(texel), vec2(0.06711056, 0.00583715)) + parameters.dither_offset));
}

#if defined(HISTORY) || defined(HALF)

// Stores residual and lobe as history and upsampling read them.
void store_kept(Surface surface, Result result, float dither) {
  if (kBentNormal) {
    vec3 residual = surface.sky ? vec3(0.0) : result.residual;
#ifdef HALF
    vec4 packed = pack_half_residual(residual, dither);
#else
    uvec4 packed = uvec4(pack_residual_dithered(residual, dither));
#endif
    imageStore(next_bent_history_image, surface.texel, packed);
  }
#ifdef SPECULAR
  // The comparisons are false for NaN, which would stay in the history.
  bool valid = !surface.sky && result.lobe.x >= 0.0 && result.lobe.y < 1e30;
  LobeTexel lobe = LobeTexel(valid ? result.lobe.x / max(result.lobe.y, 1e-30) : 0.0,
                             valid ? result.lobe.y : 0.0);
  imageStore(next_lobe_history_image, surface.texel, uvec4(pack_lobe_texel(lobe, dither)));
#endif
}

#endif
#ifdef HALF

// Stores a texel for upsampling and for the next frame. `recent` is the occlusion of the last few
// frames, which is read only with kMotion.
void store_half(Surface surface, Result result, float weight, float recent) {
  HalfTexel texel = HalfTexel(result.occlusion, weight, surface.tilt);
  imageStore(half_image, surface.texel, surface.sky ? vec4(0.0) : pack_half_texel(texel));
  float depth = surface.sky ? sky_inverse_depth(kPerspective)
                            : half_texel_depth(surface.inverse_depth, recent, kMotion);
  imageStore(half_depth_image, surface.texel, vec4(depth));
}

#else

void store(Surface surface, Result result) {
  float visibility = surface.sky ? 1.0 : 1.0 - result.occlusion;
  if (kVisibility) {
    float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
    store_visibility(surface.texel, kShaped ? shaped : visibility);
  }
  if (kBentNormal) {
    vec3 residual = surface.sky ? vec3(0.0) : result.residual;
    vec3 bent = finish_bent_normal(residual, visibility, traced_normal(surface));
    imageStore(bent_normal_image, surface.texel,
               vec4(mat3(parameters.normal_from_view) * bent, 0.0));
  }
#ifdef SPECULAR
  float occlusion = surface.sky ? 0.0 : saturate(result.lobe.x / max(result.lobe.y, 1e-30));
  imageStore(specular_image, surface.texel, vec4(1.0 - occlusion));
#endif
}

#endif

#ifdef HISTORY
#include "reconstruct_history.h"
#else

void reconstruct(Surface surface) {
  Sums sums = no_sums();
  add_ring(sums, surface, parameters.inverse_squared_window, 0);
  float scale = 1.0 / max(sums.open, 1e-37);
  Result result = Result(saturate(sums.occluded * scale), vec3(0.0), sums.lobe);
  if (kBentNormal) {
    result.residual =
        converged_residual(sums.residual, sums.expected_residual, 1.0 - result.occlusion) * scale;
  }
#ifdef HALF
  store_half(surface, result, 0.0, 0.0);
  store_kept(surface, result, 0.5);
#else
  store(surface, result);
#endif
}

#endif

void main() {
  load_tiles();
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  // At half resolution one texel beyond the border too, which upsampling reads.
  if (any(greaterThan(texel * kTexelSize, size_px() + (2 * kTexelSize - 3)))) {
    return;
  }
  reconstruct(fetch_surface(texel));
}
