// The history part of reconstruct.comp, which includes it: what a pixel has gathered over the
// frames, found where its surface was, held to what is seen now, and this frame added.
#ifndef ALCOVE_RECONSTRUCT_HISTORY_H
#define ALCOVE_RECONSTRUCT_HISTORY_H

// What a pixel has gathered so far.
struct History {
  Sum sum;        // weighted means over frames
  float count;    // frames; 0 where nothing of this surface is known
  float recent;   // visibility of the last few frames, to tell change by
  float between;  // how far from texels' centres it was read: 0 at one, to 0.5 amid four
};

const float kDepthTolerance = 0.003;      // of the depth, for a surface seen head-on
const float kPlaneTolerance = 1.0 / 3.0;  // of the filter's
// How far what moves by itself may have come nearer or gone since the last frame, of its depth.
const float kDepthMotion = 0.04;

// A texel that is of no surface: open, with nothing to weigh it by.
const uvec4 kNothingHeld = uvec4(0xffffu, 0u, 0u, 0u);

uvec4 pack_history(History history, float visibility, Surface surface) {
  // A normal that is not a number must not stay in the history.
  RawOcclusion lobe = history.sum.lobe;
  if (!(lobe.visible >= 0.0 && lobe.visible <= lobe.open && lobe.open < 1e30)) {
    lobe = RawOcclusion(0.0, 0.0);
  }
  HistoryTexel texel = HistoryTexel(visibility, history.sum.raw_occlusion.open,
                                    held_depth(parameters.history_depth.xy, surface.depth),
                                    history.count, history.recent, surface.coarse.bits);
  return uvec4(pack_history_texel(texel), floatBitsToUint(lobe.visible),
               floatBitsToUint(lobe.open));
}

// Where the surface was on the last frame's image.
struct Before {
  vec2 position;  // in pixels
  float depth;    // there, had only the camera moved; a number that can be divided by
  bool seen;      // it was on the image
  bool moves;     // not only the camera did
};

Before reproject(Surface surface) {
  float scale = kPerspective ? surface.depth : 1.0;
  vec4 standing = parameters.previous_from_pixel * vec4(surface.centre * scale, surface.depth, 1.0);
  Before before = Before(standing.xy / standing.w, standing.z, standing.w > 0.0, false);
  if (kMotion) {
    vec2 here = surface.centre * parameters.previous_size.zw;
    vec2 motion =
        texelFetch(motion_image, surface.pixel, 0).rg * parameters.motion.xy + parameters.motion.zw;
    // More than the motion vector's rounding, which in a half is 2^-11 of it.
    float apart = distance(here - motion, before.position);
    before.moves = apart > 0.1 + length(motion) * (1.0 / 512.0);
    before.position = here - motion;
  }
  before.seen = before.seen && all(greaterThanEqual(before.position, vec2(0.0))) &&
                all(lessThanEqual(before.position, parameters.previous_size.xy));
  if (!before.seen) {
    before = Before(vec2(0.0), 1.0, false, false);
  }
  return before;
}

// What was read of the last frame's texels, as sums over them.
struct Read {
  History history;
  vec3 moments;  // of the visibility
  float same;    // of one share: how much is of the same surface
  float most;    // that a texel counts for
};

// A texel of history, all of it or none as its depth and normal tell whether it is of the same
// surface; of those the ones on the tangent plane, at the depth `expected` as it is held, and with
// the same `normal`, as the last frame saw it, count for most, so that nothing leaks across a
// crease.
void add_history(inout Read read, Surface surface, QuantisedNormal normal, ivec2 pixel,
                 float expected, float share) {
  uvec4 stored = imageLoad(history_image, pixel);
  HistoryTexel texel = unpack_history_texel(stored.xy);
  float apart = held_apart(expected, texel.depth);
  float turn = kStatic ? 0.0 : squared_turn(normal, stereographic_of_bits(texel.quantised_normal));
  float same =
      history_weight(apart, kDepthTolerance, surface.n_dot_v) * history_weight_by_normal(turn);
  float off_plane = kPerspective ? apart : apart * abs(expected) / parameters.history_depth.z;
  off_plane *= surface.n_dot_v * parameters.tolerance * (1.0 / kPlaneTolerance);
  float level = 1.0 + min(off_plane * off_plane, 1e6);
  float agreement = max(1.0 - 0.5 * turn, 0.0);  // the cosine, about
  float counts = same * sixteenth_power(agreement * agreement) / (level * level);
  float weight = share * counts;
  Sum here = no_sum();
  here.raw_occlusion = RawOcclusion(texel.visibility * texel.open, texel.open);
  if (kBentNormal) {
    here.residual = imageLoad(bent_history_image, pixel).xyz;
  }
  here.lobe = RawOcclusion(uintBitsToFloat(stored.z), uintBitsToFloat(stored.w));
  add(read.history.sum, weight, here);
  read.history.count += weight * texel.count;
  read.history.recent += weight * texel.recent;
  read.moments += weight * vec3(1.0, texel.visibility, texel.visibility * texel.visibility);
  read.same += share * same;
  read.most = max(read.most, counts);
}

History no_history() { return History(no_sum(), 0.0, 0.0, 0.0); }

// Motion vectors do not say how far a surface that moves has come nearer or gone. The one of these
// texels that lies nearest to where it would have been does, if it lies near enough. As depths are
// held.
float moved_in_depth(ivec2 texels[4], vec4 expected) {
  float moved = 0.0;
  float least = kDepthMotion;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    float found = unpack_history_texel(imageLoad(history_image, texels[i]).xy).depth;
    float part = abs(found - expected[i]) / max(expected[i], 1e-6);
    if (part < least) {
      least = part;
      moved = found - expected[i];
    }
  }
  return moved;
}

// Between texels, where the surface was.
void read_moved(inout Read read, Surface surface) {
  Before before = reproject(surface);
  ivec2 last = ivec2(parameters.previous_size.xy) - 1;
  vec2 first = floor(before.position - 0.5);
  vec2 part = before.position - 0.5 - first;
  read.history.between = dot(part, 1.0 - part);
  ivec2 texels[4];
  vec4 expected;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    texels[i] = clamp(ivec2(first) + corner, ivec2(0), last);
    // Where the surface's tangent plane passes that texel; it hardly turns from frame to frame.
    vec2 offset = vec2(corner) - part;
    float inverse_depth =
        (kPerspective ? 1.0 / before.depth : before.depth) + dot(offset, surface.gradient);
    float depth = kPerspective ? 1.0 / max(inverse_depth, 0.5 / before.depth) : inverse_depth;
    expected[i] = held_depth(parameters.history_depth.zw, depth);
  }
  if (before.moves) {
    expected += moved_in_depth(texels, expected);
  }
  QuantisedNormal normal =
      make_quantised_normal(mat3(parameters.before_from_view) * surface.normal);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    vec2 near = abs(1.0 - vec2(i & 1, i >> 1) - part);
    add_history(read, surface, normal, texels[i], expected[i], before.seen ? near.x * near.y : 0.0);
  }
}

History read_history(Surface surface) {
  if (kFresh) {
    return no_history();
  }
  Read read = Read(no_history(), vec3(0.0), 0.0, 0.0);
  if (kStatic) {
    add_history(read, surface, surface.coarse, surface.pixel,
                held_depth(parameters.history_depth.zw, surface.depth), 1.0);
  } else {
    read_moved(read, surface);
  }
  float scale = read.same < 0.05 ? 0.0 : 1.0 / read.moments.x;
  History history = no_history();
  add(history.sum, scale, read.history.sum);
  history.count = read.history.count * scale;
  history.recent = read.history.recent * scale;
  history.between = read.history.between;
  if (!kStatic) {
    // From the view space of the frame before.
    history.sum.residual = history.sum.residual * mat3(parameters.before_from_view);
    vec2 means = read.moments.yz * scale;
    float variance = max(means.y - means.x * means.x, 0.0);
    float missing = max(1.0 - read.moments.x / max(read.most, 1e-20), 0.0);
    history.count = count_after_blur(history.count, variance, missing);
  }
  return history;
}

// A block of 4 gives a pixel few searches of its own even in time.
const float kWidth = kTileSize > 2 ? 2.5 : 1.0;

// Squared, in pixels: wide while a pixel has little of its own, then hardly more than the pixel
// itself, or as wide as reading between texels blurs anyway.
float squared_window(History history) {
  const float own = 0.58 * kWidth;
  return max(own * own + 2.6 * history.between,
             parameters.window_px * parameters.window_px / (history.count + 1.0));
}

// How much nearer to the tangent plane a neighbour has to be than in a first frame: the more
// searches a pixel has had of its own, the less it needs those off its plane, which see other
// things. By the error after 4 and 32 frames at each tile_size (`alcove compare --frames`).
float plane_weight_growth(float count) {
  const float own = 1.0 / float(kTileSize * kTileSize);  // in a frame
  return min(1.0 + 4.0 * own * count, 5.0);
}

void clamp_history(inout History history, Spread spread) {
  float before = mean_visibility(history.sum.raw_occlusion);
  float after = clamp_to_spread(before, spread, parameters.clamp_width);
  if (history.count > 0.0) {
    history.sum.raw_occlusion.visible = after * history.sum.raw_occlusion.open;
    history.count = count_after_clamp(history.count, before, after, 0.25);
  }
}

// Where something moves, visibility changes on surfaces that stand still: what the last few frames
// say then replaces what all of them do.
void follow_change(inout History history, RawOcclusion now) {
  float before = mean_visibility(history.sum.raw_occlusion);
  history.recent = recent_visibility(history.recent, history.count, mean_visibility(now), now.open);
  float changed = history.count > 0.0 ? visibility_changed(before, history.recent) : 0.0;
  history.sum.raw_occlusion.visible =
      mix(before, history.recent, changed) * history.sum.raw_occlusion.open;
  history.count = mix(history.count, min(history.count, kRecentFrames), changed);
}

// Whether some pixels may look further than others: a pixel that has hardly any history as far as
// all of a first frame.
const bool kLooksFurther = !kFresh && kFilterRadius > kSide;

// The next of tile_around(cell, kFilterRadius) that lies further away than those around the cell
// and is no corner.
int next_further(int i) {
  const int margin = kFilterRadius - kSide;
  int across = across_of(kFilterRadius);
  i += 1;
  bool within = i % across == margin && i / across >= margin && i / across < margin + kAcross;
  return i + (within ? kAcross : is_corner(kFilterRadius, i) ? 1 : 0);
}

void add_further(inout Neighbourhood sum, Surface surface, float inverse_squared_width) {
  int last = across_of(kFilterRadius) * across_of(kFilterRadius) - 1;
  for (int i = next_further(-1); i < last; i = next_further(i)) {
    add_tile(sum, surface, inverse_squared_width,
             fetch_tile(tile_around(surface.cell, kFilterRadius, i)));
  }
}

// The pixel's sums with this frame's neighbourhood added.
History advance(Surface surface, Found around[kAround], History history) {
  surface.plane_weight *= plane_weight_growth(history.count);
  float inverse_squared_width = inverse_squared_width_of(squared_window(history));
  Neighbourhood now = add_up(surface, inverse_squared_width, around);
  if (kLooksFurther && history.count < 2.0) {
    add_further(now, surface, inverse_squared_width);
  }
  if (kClamp) {
    vec3 moments = now.moments / now.moments.x;
    clamp_history(history, spread_of_sums(moments.y, moments.z, 1.0));
  }
  if (kMotion) {
    follow_change(history, now.sum.raw_occlusion);
  }
  // Not divided by the weight found: a frame that searched the pixel itself counts for more than
  // one that searched its neighbours. Divided by the window's size, so that wide ones do not.
  float fresh = accumulation_weight(history.count, parameters.longest);
  float scale = 0.42 * kWidth * kWidth / squared_window(history) * fresh;
  History next;
  next.sum = no_sum();
  add(next.sum, 1.0 - fresh, history.sum);
  add(next.sum, scale, now.sum);
  if (kBentNormal) {
    float visibility = mean_visibility(next.sum.raw_occlusion);
    next.sum.residual =
        converged_residual(next.sum.residual, scale * now.expected_residual, visibility);
  }
  next.count = next_count(history.count, parameters.longest);
  next.recent = kMotion ? history.recent : mean_visibility(next.sum.raw_occlusion);
  return next;
}

#endif
