#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// From traced pixels to every pixel: the paper's spatial filter, the upsampling of a search at
// lower resolution, and (compiled with HISTORY) accumulation over frames. They read the same
// neighbourhood with the same weights, so they are one pass, and what is off is not compiled in.
//
// A block of kTileSize x kTileSize pixels has one search a frame, of a pixel that moves through the
// block from frame to frame: every pixel is searched at its own depth in time, and edges come back
// sharp. With a history a pixel looks at the four searched ones around it; without one, or while it
// has next to nothing of its own there, at the 4x4 around it (`kFilterRadius` is 2) but for the
// corners, which would cost a fourth and have a tenth of the weight. They weigh by their distance
// on the image, in a window that narrows as a pixel gathers frames, by their distance from the
// pixel's tangent plane, so that a plane at any tilt is filtered whole and nothing leaks across an
// edge, and by their normals, so that little leaks across a crease. Sums are added up, visible and
// open parts each, and divided last. Those of the GGX lobe weigh by normal and roughness too: the
// narrower the lobe, the more of it hangs on where it points.

#include "maths/bent_normal.h"
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
layout(constant_id = 6) const bool kStatic = false;  // nothing moved since the last frame
layout(constant_id = 7) const bool kRoughnessTexture = false;
layout(constant_id = 8) const int kRoughnessChannel = 0;
layout(constant_id = 9) const bool kFresh = true;        // there is no history to read yet
layout(constant_id = 10) const bool kVisibility = true;  // else it is found but not written
// Still for so long that only pixels which this frame's searches reached have anything to learn.
layout(constant_id = 11) const bool kConverged = false;
layout(constant_id = 12) const uint kNormalEncoding = 0;  // as NormalEncoding has them
layout(constant_id = 13) const bool kShaped = false;      // power or intensity is not 1

#ifdef SPECULAR
const bool kLobe = true;
#define RAW_FORMAT rgba32ui
#else
const bool kLobe = false;
#define RAW_FORMAT rg32ui
#endif

layout(set = 0, binding = 0) uniform Parameters { ReconstructParameters given; };
// Loaded once: a driver may load what is uniform again after each store.
ReconstructParameters parameters;
// What our own passes wrote is read as storage: a texel at a known place needs no sampler.
layout(set = 0, binding = 1, RAW_FORMAT) uniform readonly uimage2D raw_image;  // by blocks
// Where there is none, the raw_occlusion.
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D bent_image;
layout(set = 0, binding = 3,
       r32f) uniform readonly image2D inverse_depth_image;    // SliceSample::inverse_depth
layout(set = 0, binding = 4) uniform texture2D normal_image;  // xyz
// Bound to another result and never written where it is not wanted, as is the next.
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
#ifdef HISTORY
layout(set = 0, binding = 7) uniform texture2D motion_image;  // where there is none, the normals
layout(set = 0, binding = 8, RAW_FORMAT) uniform readonly uimage2D history_image;
// Where there is none, the inverse depth.
layout(set = 0, binding = 9, rgba16f) uniform readonly image2D bent_history_image;
// With kStatic these are the two before, updated in place.
layout(set = 0, binding = 10) uniform writeonly uimage2D next_history_image;
layout(set = 0, binding = 11) uniform writeonly image2D next_bent_history_image;
const int kFirstLobeBinding = 12;
#else
const int kFirstLobeBinding = 7;
#endif
#ifdef SPECULAR
layout(set = 0, binding = kFirstLobeBinding) uniform texture2D roughness_image;  // perceptual
layout(set = 0, binding = kFirstLobeBinding + 1) uniform writeonly image2D specular_image;
#endif

// Whether pixels lie between searched ones; else each was searched, or takes what its block has.
const bool kBetween = kTileSize > 1 && kFilterRadius > 0;
// Searched pixels that a pixel looks at: so many on each side, and its own where it has one.
const int kSide = kFresh || kFilterRadius == 0 ? kFilterRadius : 1;
const int kAcross = kBetween ? 2 * kSide : 2 * kSide + 1;
const int kAround = kAcross * kAcross;

struct Surface {
  ivec2 pixel;
  ivec2 cell;           // that the pixel is in
  vec2 centre;          // of the pixel, pixels
  float inverse_depth;  // linear along the image of any plane: 1/depth in perspective, depth
                        // otherwise
  float depth;          // linear
  vec2 gradient;        // of `line` on the tangent plane, for each pixel
  float plane_weight;   // tolerances that a unit of `line` off the tangent plane stands for
  float n_dot_v;        // cosine between normal and view vector, on the axis
  vec3 normal;          // unit, towards the eye, view space
  QuantisedNormal coarse;
  LobeSurface lobe;  // normal as it was given
};

// What is added up: over neighbours, then over frames.
struct Sum {
  RawOcclusion raw_occlusion;
  vec3 residual;
  RawOcclusion lobe;
};

ivec2 size_px() { return imageSize(inverse_depth_image); }

#include "depth_normal.h"

// Not unit, in the space of the normals; from depth where the texture has no direction.
vec3 fetch_normal(ivec2 pixel) {
  vec3 given = decode_normal(texelFetch(normal_image, pixel, 0).xyz, kNormalEncoding);
  return has_direction(given) ? given : mat3(parameters.normal_from_view) * depth_normal(pixel);
}

LobeSurface fetch_lobe_surface(ivec2 pixel, vec3 normal) {
  LobeSurface surface = LobeSurface(normal, parameters.roughness);
#ifdef SPECULAR
  if (kRoughnessTexture) {
    surface.roughness = saturate(texelFetch(roughness_image, pixel, 0)[kRoughnessChannel]);
  }
#endif
  return surface;
}

Surface fetch_surface(ivec2 pixel, ivec2 cell, float inverse_depth) {
  Surface surface;
  surface.pixel = pixel;
  surface.cell = cell;
  surface.centre = vec2(pixel) + 0.5;
  surface.inverse_depth = inverse_depth;
  surface.depth = kPerspective ? 1.0 / surface.inverse_depth : surface.inverse_depth;
  vec3 given = fetch_normal(pixel);
  vec3 normal = normalize(given * mat3(parameters.normal_from_view));
  // dot((x s, y s, depth), plane) is constant on the tangent plane, x and y in pixels and s the
  // depth in perspective and 1 otherwise.
  vec3 plane =
      vec3(normal.xy * parameters.slope.xy, dot(normal.xy, parameters.slope.zw) - normal.z);
  // How the distance from the plane grows with depth along the pixel's ray. Seen edge-on, a plane
  // would run to any depth.
  float along = plane.z + (kPerspective ? dot(surface.centre, plane.xy) : 0.0);
  surface.n_dot_v = max(abs(along), 0.02);
  float per_line = (along < 0.0 ? -1.0 : 1.0) / surface.n_dot_v;
  surface.gradient = plane.xy * (kPerspective ? surface.inverse_depth * per_line : -per_line);
  surface.plane_weight =
      surface.n_dot_v * parameters.tolerance * (kPerspective ? surface.depth : 1.0);
  surface.normal = along > 0.0 ? -normal : normal;
  surface.coarse = make_quantised_normal(surface.normal);
  surface.lobe = fetch_lobe_surface(pixel, given);
  return surface;
}

Sum no_sum() {
  Sum sum;
  sum.raw_occlusion.visible = 0.0;
  sum.raw_occlusion.open = 0.0;
  sum.residual = vec3(0.0);
  sum.lobe = sum.raw_occlusion;
  return sum;
}

void add(inout RawOcclusion sum, float weight, RawOcclusion more) {
  sum.visible += weight * more.visible;
  sum.open += weight * more.open;
}

void add(inout Sum sum, float weight, Sum more) {
  add(sum.raw_occlusion, weight, more.raw_occlusion);
  if (kBentNormal) {
    sum.residual += weight * more.residual;
  }
  if (kLobe) {
    add(sum.lobe, weight, more.lobe);
  }
}

// What a block's search found, and where.
struct Found {
  Sum sum;  // the lobe as it is for the searched surface
  vec3 expected_residual;
  uint lobe_surface;
  vec2 searched;  // pixel
  float inverse_depth;
  vec2 stereographic;  // QuantisedNormal::stereographic
};

Found fetch_tile(ivec2 block) {
  uvec4 stored = imageLoad(raw_image, block);
  Found found;
  found.sum = no_sum();
  found.sum.raw_occlusion = unpack_raw_occlusion(stored.x);
  found.inverse_depth = uintBitsToFloat(stored.y);
  found.stereographic = stereographic_of_bits(raw_occlusion_normal(stored.x));
  found.searched =
      vec2(min(block * kTileSize + ivec2(parameters.interleave_offset), size_px() - 1));
  if (kBentNormal) {
    uvec2 bent = imageLoad(bent_image, block).xy;
    found.sum.residual = unpack_residual(bent.x);
    found.expected_residual = unpack_residual(bent.y);
  }
  if (kLobe) {
    found.sum.lobe = unpack_lobe(stored.z);
    found.lobe_surface = stored.w;
  }
  return found;
}

ivec2 last_tile() { return (size_px() + (kTileSize - 1)) / kTileSize - 1; }

int across_of(int side) { return kBetween ? 2 * side : 2 * side + 1; }

// Block i by rows of those around a cell, `side` on each side. Beyond the image the outermost stand
// for those that there are not.
ivec2 tile_around(ivec2 cell, int side, int i) {
  int across = across_of(side);
  ivec2 block = cell + ivec2(i % across, i / across) - (kBetween ? side - 1 : side);
  return clamp(block, ivec2(0), last_tile());
}

// Of those, one that nothing looks at.
bool is_corner(int side, int i) {
  int last = across_of(side) - 1;
  ivec2 place = ivec2(i % (last + 1), i / (last + 1));
  return side > 1 && (place.x == 0 || place.x == last) && (place.y == 0 || place.y == last);
}

// A neighbour at distance d weighs 1 / (1 + inverse_squared_width d^2)^4.
float inverse_squared_width_of(float squared_width_px) { return 0.125 / squared_width_px; }

// A neighbour across a crease weighs no less than 1 / (1 + this)^2, a fifth: where there are few
// others its search is better than none. By the error of first frames (`alcove compare --frames
// 1`).
const float kWidestTurn = 1.23;

// What a neighbour's search weighs: it falls with the distance on the image, with that from the
// tangent plane and with the angle between normals, and never to nothing: where no neighbour lies
// on the plane, the nearest to it count.
float neighbour_weight(Surface surface, float inverse_squared_width, vec2 offset, Found found) {
  float off_plane = (found.inverse_depth - surface.inverse_depth - dot(offset, surface.gradient)) *
                    surface.plane_weight;
  float near = 1.0 + inverse_squared_width * dot(offset, offset);
  float level = 1.0 + min(off_plane * off_plane, 1e16);  // whose square still is a float
  level += min(squared_turn(surface.coarse, found.stereographic), kWidestTurn);
  float both = near * near * level;
  return 1.0 / (both * both);
}

struct Neighbourhood {
  Sum sum;
  vec3 expected_residual;
  vec3 moments;  // of the visibility
};

void add_tile(inout Neighbourhood sum, Surface surface, float inverse_squared_width, Found found) {
  vec2 offset = found.searched - vec2(surface.pixel);
  float weight = neighbour_weight(surface, inverse_squared_width, offset, found);
  add(sum.sum.raw_occlusion, weight, found.sum.raw_occlusion);
  if (kBentNormal) {
    sum.sum.residual += weight * found.sum.residual;
    sum.expected_residual += weight * found.expected_residual;
  }
  if (kLobe) {
    // As far as it is like the surface's own.
    add(sum.sum.lobe, weight * lobe_weight(surface.lobe, found.lobe_surface), found.sum.lobe);
  }
  if (kClamp) {
    float visibility = found.sum.raw_occlusion.visible / max(found.sum.raw_occlusion.open, 1e-9);
    sum.moments += weight * vec3(1.0, visibility, visibility * visibility);
  }
}

Neighbourhood add_up(Surface surface, float inverse_squared_width, Found around[kAround]) {
  Neighbourhood sum = Neighbourhood(no_sum(), vec3(0.0), vec3(0.0));
  [[unroll]] for (int i = 0; i < kAround; ++i) {
    if (!is_corner(kSide, i)) {
      add_tile(sum, surface, inverse_squared_width, around[i]);
    }
  }
  return sum;
}

// In view space, as a search of the pixel takes it.
vec3 traced_normal(ivec2 pixel) {
  vec2 slope =
      parameters.slope.zw + (kPerspective ? (vec2(pixel) + 0.5) * parameters.slope.xy : vec2(0.0));
  vec3 given = decode_normal(texelFetch(normal_image, pixel, 0).xyz, kNormalEncoding) *
               mat3(parameters.normal_from_view);
  return seen_normal(pixel, given, normalize(vec3(-slope, 1.0)));
}

void store(ivec2 pixel, Sum sum, float visibility) {
  if (kVisibility) {
    float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
    imageStore(visibility_image, pixel, vec4(kShaped ? shaped : visibility));
  }
  if (kBentNormal) {
    vec3 bent = finish_bent_normal(sum.residual, sum.raw_occlusion.visible, traced_normal(pixel));
    imageStore(bent_normal_image, pixel, vec4(mat3(parameters.normal_from_view) * bent, 0.0));
  }
#ifdef SPECULAR
  imageStore(specular_image, pixel, vec4(mean_visibility(sum.lobe)));
#endif
}

#ifdef HISTORY

#include "reconstruct_history.h"

// Stores are many to a pixel and take turns on a processor: the sky has none of its own.
void reconstruct(Surface surface, bool sky, Found around[kAround]) {
  History next = advance(surface, around, read_history(surface));
  float visibility = mean_visibility(next.sum.raw_occlusion);
  uvec4 packed = pack_history(next, visibility, surface);
  if (sky) {
    next.sum = no_sum();
    visibility = 1.0;
    packed = kNothingHeld;
  }
  imageStore(next_history_image, surface.pixel, packed);
  if (kBentNormal) {
    imageStore(next_bent_history_image, surface.pixel, vec4(next.sum.residual, 0.0));
  }
  store(surface.pixel, next.sum, visibility);
}

#else

void reconstruct(Surface surface, bool sky, Found around[kAround]) {
  float inverse_squared_width =
      inverse_squared_width_of(parameters.window_px * parameters.window_px);
  Neighbourhood now = add_up(surface, inverse_squared_width, around);
  Sum sum = now.sum;
  sum.residual =
      converged_residual(sum.residual, now.expected_residual, mean_visibility(sum.raw_occlusion));
  if (sky) {
    sum = no_sum();
  }
  store(surface.pixel, sum, mean_visibility(sum.raw_occlusion));
}

#endif

void reconstruct_pixel(ivec2 pixel, ivec2 cell, Found around[kAround]) {
  float inverse_depth = imageLoad(inverse_depth_image, pixel).r;
  reconstruct(fetch_surface(pixel, cell, inverse_depth),
              inverse_depth == sky_inverse_depth(kPerspective), around);
}

// As reconstruct_pixel, for a pixel of which this frame tells nothing new.
void keep_pixel(ivec2 pixel) {
#ifdef HISTORY
  uvec4 stored = imageLoad(history_image, pixel);
  Sum sum = no_sum();
  if (kBentNormal) {
    sum.residual = imageLoad(bent_history_image, pixel).xyz;
  }
  sum.lobe = RawOcclusion(uintBitsToFloat(stored.z), uintBitsToFloat(stored.w));
  HistoryTexel texel = unpack_history_texel(stored.xy);
  sum.raw_occlusion = RawOcclusion(texel.visibility * texel.open, texel.open);
  store(pixel, sum, texel.visibility);
#endif
}

// Pixels of a cell, a bit each by rows from the first, a searched one: those next to a searched one
// of a cell of 4x4, the searched one itself of a smaller.
const uint kCell = kTileSize == 4 ? 0xffffu : kTileSize == 2 ? 0xfu : 1u;
const uint kReached = kConverged && kBetween ? (kTileSize == 4 ? 0x101bu : 1u) : kCell;

ivec2 pixel_of_bit(ivec2 first, uint bits) {
  int i = findLSB(bits);
  return first + ivec2(i % kTileSize, i / kTileSize);
}

bool inside(ivec2 pixel) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size_px()));
}

// Each invocation has the kTileSize x kTileSize pixels of a cell, which look at the same searched
// ones: those are fetched once. With kBetween a cell lies between four traced pixels, else it is
// a block.
void main() {
  parameters = given;
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy) - (kBetween ? 1 : 0);
  ivec2 first = cell * kTileSize + (kBetween ? ivec2(parameters.interleave_offset) : ivec2(0));
  if (any(greaterThanEqual(first, size_px()))) {
    return;
  }
  Found around[kAround];
  [[unroll]] for (int i = 0; i < kAround; ++i) {
    if (!is_corner(kSide, i)) {
      around[i] = fetch_tile(tile_around(cell, kSide, i));
    }
  }
  uint reached = kReached;
  do {
    ivec2 pixel = pixel_of_bit(first, reached);
    if (inside(pixel)) {
      reconstruct_pixel(pixel, cell, around);
    }
    reached &= reached - 1;
  } while (reached != 0);
  if (kReached != kCell) {
    uint rest = kCell ^ kReached;
    do {
      ivec2 pixel = pixel_of_bit(first, rest);
      if (inside(pixel)) {
        keep_pixel(pixel);
      }
      rest &= rest - 1;
    } while (rest != 0);
  }
}
