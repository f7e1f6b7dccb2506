#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// From searched pixels to every pixel: the memo's spatial filter, the upsampling of a search at lower
// resolution, and (compiled with HISTORY) accumulation over frames. They read the same neighbourhood
// with the same weights, so they are one pass, and what is off is not compiled in.
//
// A block of kDivisor x kDivisor pixels has one search a frame, of a pixel that moves through the
// block from frame to frame: every pixel is searched at its own depth in time, and edges come back
// sharp. Without a history a pixel looks at all blocks within reach; with one, at the four searched
// pixels around it. They weigh by their distance on the image, in a window that narrows as a pixel
// gathers frames, and by their distance from the pixel's tangent plane, so that a plane at any tilt
// is filtered whole and nothing leaks across an edge. Sums are added up, visible and open parts each,
// and divided last. Those of the GGX lobe weigh by normal and roughness too: the narrower the lobe,
// the more of it hangs on where it points.

#include "maths/bent_normal.h"
#include "maths/gtao.h"
#include "maths/history.h"
#include "maths/lobe_slice.h"
#include "maths/projection.h"
#include "maths/signal.h"
#include "maths/slice_line.h"
#include "reconstruct_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int kDivisor = 1;
layout(constant_id = 1) const int kReach = 2;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const bool kMotion = false;
layout(constant_id = 4) const bool kPerspective = true;
layout(constant_id = 5) const bool kClamp = false;
layout(constant_id = 6) const bool kStill = false;  // nothing moved since the last frame
layout(constant_id = 7) const bool kRoughnessTexture = false;
layout(constant_id = 8) const int kRoughnessChannel = 0;
layout(constant_id = 9) const bool kFresh = true;  // there is no history to read yet
layout(constant_id = 10) const bool kVisibility = true;  // else it is found but not written
// Still for so long that only pixels which this frame's searches reached have anything to learn.
layout(constant_id = 11) const bool kSettled = false;

#ifdef LOBE
const bool kLobe = true;
#define SIGNAL_FORMAT rgba32ui
#else
const bool kLobe = false;
#define SIGNAL_FORMAT rg32ui
#endif

layout(set = 0, binding = 0) uniform Parameters { ReconstructParameters parameters; };
// What our own passes wrote is read as storage: a texel at a known place needs no sampler.
layout(set = 0, binding = 1, SIGNAL_FORMAT) uniform readonly uimage2D signal_image;  // one texel a block
// Where there is none, the signal.
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D bent_image;
layout(set = 0, binding = 3, r32f) uniform readonly image2D line_image;  // LineSample::line
layout(set = 0, binding = 4) uniform texture2D normal_image;             // xyz
// Bound to another result and never written where it is not wanted, as is the next.
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
#ifdef HISTORY
layout(set = 0, binding = 7) uniform texture2D motion_image;  // where there is none, the normals
layout(set = 0, binding = 8, SIGNAL_FORMAT) uniform readonly uimage2D history_image;
layout(set = 0, binding = 9) uniform texture2D bent_history_image;
layout(set = 0, binding = 10) uniform writeonly uimage2D next_history_image;
layout(set = 0, binding = 11) uniform writeonly image2D next_bent_history_image;
const int kFirstLobeBinding = 12;
#else
const int kFirstLobeBinding = 7;
#endif
#ifdef LOBE
layout(set = 0, binding = kFirstLobeBinding) uniform texture2D roughness_image;  // perceptual
layout(set = 0, binding = kFirstLobeBinding + 1) uniform writeonly image2D specular_image;
#endif

// Whether pixels look at the four searched ones around them; else at all within reach.
#ifdef HISTORY
const bool kBetween = kDivisor > 1 && kReach > 0 && !kFresh;
#else
const bool kBetween = false;
#endif

struct Surface {
  ivec2 pixel;
  vec2 centre;    // of the pixel, pixels
  float line;     // linear along the image of any plane: 1/depth in perspective, depth otherwise
  float depth;    // linear
  vec2 gradient;  // of `line` on the tangent plane, for each pixel
  float stiffness;  // tolerances that a unit of `line` off the tangent plane stands for
  float slant;    // cosine between normal and view vector, on the axis
  LobeSurface lobe;
};

// What is added up: over neighbours, then over frames.
struct Sum {
  Signal signal;
  vec3 bent;
  Signal lobe;
};

ivec2 size_px() { return imageSize(line_image); }

LobeSurface fetch_lobe_surface(ivec2 pixel, vec3 normal) {
  LobeSurface surface = LobeSurface(normal, parameters.roughness);
#ifdef LOBE
  if (kRoughnessTexture) {
    surface.roughness = texelFetch(roughness_image, pixel, 0)[kRoughnessChannel];
  }
#endif
  return surface;
}

Surface fetch_surface(ivec2 pixel, float line) {
  Surface surface;
  surface.pixel = pixel;
  surface.centre = vec2(pixel) + 0.5;
  surface.line = line;
  surface.depth = kPerspective ? 1.0 / surface.line : surface.line;
  vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
  vec3 plane = mat3(parameters.plane_from_normal) * normal;
  // How the distance from the plane grows with depth along the pixel's ray. Seen edge-on, a plane
  // would run to any depth.
  float along = plane.z + (kPerspective ? dot(surface.centre, plane.xy) : 0.0);
  surface.slant = max(abs(along), 0.02);
  float per_line = (along < 0.0 ? -1.0 : 1.0) / surface.slant;
  surface.gradient = plane.xy * (kPerspective ? surface.line * per_line : -per_line);
  surface.stiffness =
      surface.slant * parameters.tolerance * (kPerspective ? surface.depth : 1.0);
  surface.lobe = fetch_lobe_surface(pixel, normal);
  return surface;
}

Sum no_sum() {
  Sum sum;
  sum.signal.visible = 0.0;
  sum.signal.open = 0.0;
  sum.bent = vec3(0.0);
  sum.lobe = sum.signal;
  return sum;
}

void add(inout Signal sum, float weight, Signal more) {
  sum.visible += weight * more.visible;
  sum.open += weight * more.open;
}

void add(inout Sum sum, float weight, Sum more) {
  add(sum.signal, weight, more.signal);
  if (kBentNormal) {
    sum.bent += weight * more.bent;
  }
  if (kLobe) {
    add(sum.lobe, weight, more.lobe);
  }
}

// What a block's search found, and where.
struct Found {
  Sum sum;  // the lobe as it is for the searched surface
  uint lobe_surface;
  vec2 searched;  // pixel
  float line;
};

Found fetch_block(ivec2 block) {
  uvec4 stored = imageLoad(signal_image, block);
  Found found;
  found.sum = no_sum();
  found.sum.signal = unpack_signal(stored.x);
  found.line = uintBitsToFloat(stored.y);
  found.searched = vec2(min(block * kDivisor + ivec2(parameters.phase), size_px() - 1));
  if (kBentNormal) {
    found.sum.bent = unpack_direction(imageLoad(bent_image, block).xy);
  }
  if (kLobe) {
    found.sum.lobe = unpack_lobe(stored.z);
    found.lobe_surface = stored.w;
  }
  return found;
}

ivec2 last_block() {
  return (size_px() + (kDivisor - 1)) / kDivisor - 1;
}

// A neighbour at distance d weighs 1 / (1 + narrowness d^2)^4.
float narrowness_of(float width_px) { return 0.125 / (width_px * width_px); }

// What a neighbour's search weighs: it falls with the distance on the image and with that from the
// tangent plane, and never to nothing. Where no neighbour lies on the plane the nearest to it count.
float neighbour_weight(Surface surface, float narrowness, vec2 offset, float line) {
  float off_plane =
      (line - surface.line - dot(offset, surface.gradient)) * surface.stiffness;
  float near = 1.0 + narrowness * dot(offset, offset);
  float level = 1.0 + off_plane * off_plane;
  float both = near * near * level;
  return 1.0 / (both * both);
}

struct Neighbourhood {
  Sum sum;
  vec3 moments;  // of the visibility
};

void add_block(inout Neighbourhood sum, Surface surface, float narrowness, Found found) {
  vec2 offset = found.searched - vec2(surface.pixel);
  float weight = neighbour_weight(surface, narrowness, offset, found.line);
  add(sum.sum.signal, weight, found.sum.signal);
  if (kBentNormal) {
    sum.sum.bent += weight * found.sum.bent;
  }
  if (kLobe) {
    // As far as it is like the surface's own.
    add(sum.sum.lobe, weight * lobe_weight(surface.lobe, found.lobe_surface), found.sum.lobe);
  }
  if (kClamp) {
    float visibility = found.sum.signal.visible / max(found.sum.signal.open, 1e-9);
    sum.moments += weight * vec3(1.0, visibility, visibility * visibility);
  }
}

// All blocks within reach of the pixel's own; the outermost stand for those outside the image.
Neighbourhood gather(Surface surface, int reach, float narrowness) {
  ivec2 own = surface.pixel / kDivisor;
  Neighbourhood sum = Neighbourhood(no_sum(), vec3(0.0));
  [[unroll]] for (int y = -reach; y <= reach; ++y) {
    [[unroll]] for (int x = -reach; x <= reach; ++x) {
      ivec2 block = clamp(own + ivec2(x, y), ivec2(0), last_block());
      add_block(sum, surface, narrowness, fetch_block(block));
    }
  }
  return sum;
}

void store(ivec2 pixel, Sum sum) {
  if (kVisibility) {
    float visibility = mean_visibility(sum.signal.visible, sum.signal.open);
    imageStore(visibility_image, pixel, vec4(visibility));
  }
  if (kBentNormal) {
    vec3 fallback = texelFetch(normal_image, pixel, 0).xyz;
    vec3 bent = finish_bent_normal(mat3(parameters.normal_from_view) * sum.bent, fallback);
    imageStore(bent_normal_image, pixel, vec4(bent, 0.0));
  }
#ifdef LOBE
  imageStore(specular_image, pixel, vec4(lobe_visibility(sum.lobe.visible, sum.lobe.open)));
#endif
}

#ifdef HISTORY

// What a pixel has gathered so far.
struct History {
  Sum sum;       // weighted means over frames
  float count;   // frames; 0 where nothing of this surface is known
  float recent;  // visibility of the last few frames, to tell change by
};

const float kDepthTolerance = 0.004;  // of the depth, for a surface seen head-on
const float kLargestDepth = 6e4;     // of a half

uvec4 pack_history(History history, float depth) {
  // A normal that is not a number must not stay in the history.
  Signal lobe = history.sum.lobe;
  if (!(lobe.visible >= 0.0 && lobe.visible <= lobe.open && lobe.open < 1e30)) {
    lobe = Signal(0.0, 0.0);
  }
  return uvec4(pack_signal(history.sum.signal),
               pack_history_state(min(depth, kLargestDepth), history.count, history.recent),
               floatBitsToUint(lobe.visible), floatBitsToUint(lobe.open));
}

// Where the surface was on the last frame's image: xy in pixels, z its depth there, w 0 if it was
// not on it (and z then no more than a number that can be divided by).
vec4 reproject(Surface surface) {
  float scale = kPerspective ? surface.depth : 1.0;
  vec4 before = parameters.previous_from_pixel * vec4(surface.centre * scale, surface.depth, 1.0);
  vec2 position = before.xy / before.w;
  if (kMotion) {
    vec2 motion = texelFetch(motion_image, surface.pixel, 0).rg;
    position = surface.centre - motion * vec2(size_px());
  }
  bool seen = before.w > 1e-6 && all(greaterThanEqual(position, vec2(0.0))) &&
              all(lessThanEqual(position, vec2(size_px())));
  return seen ? vec4(position, before.z, 1.0) : vec4(0.0, 0.0, 1.0, 0.0);
}

// A texel of history, all of it or none as its depth tells whether it is of the same surface.
float add_history(inout History history, Surface surface, ivec2 texel, float depth, float share) {
  uvec4 stored = imageLoad(history_image, texel);
  HistoryState state = unpack_history_state(stored.y);
  float weight = share * history_weight(min(depth, kLargestDepth), state.depth,
                                        kDepthTolerance, surface.slant);
  Sum here = no_sum();
  here.signal = unpack_signal(stored.x);
  if (kBentNormal) {
    here.bent = texelFetch(bent_history_image, texel, 0).xyz;
  }
  here.lobe = Signal(uintBitsToFloat(stored.z), uintBitsToFloat(stored.w));
  add(history.sum, weight, here);
  history.count += weight * state.count;
  history.recent += weight * state.recent;
  return weight;
}

History read_history(Surface surface) {
  History found;
  found.sum = no_sum();
  found.count = 0.0;
  found.recent = 0.0;
  float weight_sum = 0.0;
  if (kFresh) {
    return found;
  }
  if (kStill) {
    weight_sum = add_history(found, surface, surface.pixel, surface.depth, 1.0);
  } else {
    vec4 before = reproject(surface);
    vec2 first = floor(before.xy - 0.5);
    vec2 part = before.xy - 0.5 - first;
    for (int i = 0; i < 4; ++i) {
      ivec2 corner = ivec2(i & 1, i >> 1);
      ivec2 texel = clamp(ivec2(first) + corner, ivec2(0), size_px() - 1);
      vec2 near = abs(1.0 - vec2(corner) - part);
      // Where the surface's tangent plane passes that texel; it hardly turns from frame to frame.
      vec2 offset = vec2(corner) - part;
      float line = (kPerspective ? 1.0 / before.z : before.z) + dot(offset, surface.gradient);
      float depth = kPerspective ? 1.0 / max(line, 0.5 / before.z) : line;
      weight_sum += add_history(found, surface, texel, depth, near.x * near.y * before.w);
    }
  }
  float scale = weight_sum < 0.05 ? 0.0 : 1.0 / weight_sum;
  History history;
  history.sum = no_sum();
  add(history.sum, scale, found.sum);
  history.count = found.count * scale;
  history.recent = found.recent * scale;
  return history;
}

// A block of 4 gives a pixel few searches of its own even in time.
const float kWidth = kDivisor > 2 ? 2.5 : 1.0;

// Wide while a pixel has little of its own, then hardly more than the pixel itself.
float window_width(float count) { return max(0.58 * kWidth, 2.0 * inversesqrt(count + 1.0)); }

// What this frame found around a pixel that holds so many frames.
Neighbourhood look_around(Surface surface, Found corners[4], float count) {
  float narrowness = narrowness_of(window_width(count));
  if (!kBetween) {
    return gather(surface, kFresh ? kReach : min(kReach, 1), narrowness);
  }
  Neighbourhood sum = Neighbourhood(no_sum(), vec3(0.0));
  for (int i = 0; i < 4; ++i) {
    add_block(sum, surface, narrowness, corners[i]);
  }
  return sum;
}

void clamp_history(inout History history, Spread spread) {
  float before = mean_visibility(history.sum.signal.visible, history.sum.signal.open);
  float after = clamp_to_spread(before, spread, parameters.clamp_width);
  if (history.count > 0.0) {
    history.sum.signal.visible = after * history.sum.signal.open;
    history.count = count_after_clamp(history.count, before, after, 0.25);
  }
}

// Where something moves, visibility changes on surfaces that stand still: what the last few frames say
// then replaces what all of them do.
void follow_change(inout History history, Signal now) {
  float before = mean_visibility(history.sum.signal.visible, history.sum.signal.open);
  history.recent = recent_visibility(history.recent, history.count,
                                     mean_visibility(now.visible, now.open));
  float changed = history.count > 0.0 ? visibility_changed(before, history.recent) : 0.0;
  history.sum.signal.visible =
      mix(before, history.recent, changed) * history.sum.signal.open;
  history.count = mix(history.count, min(history.count, kRecentFrames), changed);
}

// The pixel's sums with this frame's neighbourhood added.
History advance(Surface surface, Found corners[4], History history) {
  Neighbourhood now = look_around(surface, corners, history.count);
  if (kClamp) {
    vec3 moments = now.moments / now.moments.x;
    clamp_history(history, spread_of_sums(moments.y, moments.z, 1.0));
  }
  if (kMotion) {
    follow_change(history, now.sum.signal);
  }
  // Not divided by the weight found: a frame that searched the pixel itself counts for more than one
  // that searched its neighbours. Divided by the window's size, so that wide ones do not.
  float width = window_width(history.count);
  float fresh = accumulation_weight(history.count, parameters.longest);
  float scale = 0.42 * kWidth * kWidth / (width * width) * fresh;
  History next;
  next.sum = no_sum();
  add(next.sum, 1.0 - fresh, history.sum);
  add(next.sum, scale, now.sum);
  next.count = next_count(history.count, parameters.longest);
  next.recent = kMotion ? history.recent
                        : mean_visibility(next.sum.signal.visible, next.sum.signal.open);
  return next;
}

// Stores are many to a pixel and take turns on a processor: the sky has none of its own.
void reconstruct(Surface surface, bool sky, Found corners[4]) {
  History next = advance(surface, corners, read_history(surface));
  uvec4 packed = pack_history(next, surface.depth);
  if (sky) {
    next.sum = no_sum();
    packed = uvec4(0u);
  }
  imageStore(next_history_image, surface.pixel, packed);
  if (kBentNormal) {
    imageStore(next_bent_history_image, surface.pixel, vec4(next.sum.bent, 0.0));
  }
  store(surface.pixel, next.sum);
}

#else

void reconstruct(Surface surface, bool sky, Found corners[4]) {
  float width = float(kDivisor) * (kReach > 1 ? 1.5 : 1.0);
  Sum sum = gather(surface, kReach, narrowness_of(width)).sum;
  if (sky) {
    sum = no_sum();
  }
  store(surface.pixel, sum);
}

#endif

void reconstruct_pixel(ivec2 pixel, Found corners[4]) {
  float line = imageLoad(line_image, pixel).r;
  reconstruct(fetch_surface(pixel, line), line == sky_line(kPerspective), corners);
}

// As reconstruct_pixel, for a pixel of which this frame tells nothing new.
void keep_pixel(ivec2 pixel) {
#ifdef HISTORY
  uvec4 stored = imageLoad(history_image, pixel);
  imageStore(next_history_image, pixel, stored);
  Sum sum = no_sum();
  sum.signal = unpack_signal(stored.x);
  if (kBentNormal) {
    vec4 bent = texelFetch(bent_history_image, pixel, 0);
    imageStore(next_bent_history_image, pixel, bent);
    sum.bent = bent.xyz;
  }
  sum.lobe = Signal(uintBitsToFloat(stored.z), uintBitsToFloat(stored.w));
  store(pixel, sum);
#endif
}

// Pixels of a cell, a bit each by rows from the first, a searched one: those next to a searched one of
// a cell of 4x4, the searched one itself of a smaller.
const uint kCell = kDivisor == 4 ? 0xffffu : kDivisor == 2 ? 0xfu : 1u;
const uint kReached = kSettled && kBetween ? (kDivisor == 4 ? 0x101bu : 1u) : kCell;

ivec2 pixel_of_bit(ivec2 first, uint bits) {
  int i = findLSB(bits);
  return first + ivec2(i % kDivisor, i / kDivisor);
}

bool inside(ivec2 pixel) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size_px()));
}

// Each invocation has kDivisor x kDivisor pixels: with kBetween those of the cell between four searched
// ones, which are fetched once for all of them, else those of a block.
void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy) - (kBetween ? 1 : 0);
  ivec2 first = cell * kDivisor + (kBetween ? ivec2(parameters.phase) : ivec2(0));
  if (any(greaterThanEqual(first, size_px()))) {
    return;
  }
  Found corners[4];
  if (kBetween) {
    for (int i = 0; i < 4; ++i) {
      corners[i] = fetch_block(clamp(cell + ivec2(i & 1, i >> 1), ivec2(0), last_block()));
    }
  }
  uint reached = kReached;
  do {
    ivec2 pixel = pixel_of_bit(first, reached);
    if (inside(pixel)) {
      reconstruct_pixel(pixel, corners);
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
