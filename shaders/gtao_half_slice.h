// Part of gtao.comp: where the depth samples of one half-slice lie, and what the depth buffer shows
// there. All estimators use it.
#ifndef ALCOVE_GTAO_HALF_SLICE_H
#define ALCOVE_GTAO_HALF_SLICE_H

// One of the two directions of a slice, in which depth samples are taken outwards from the shaded
// point.
struct HalfSlice {
  float side;  // +1 along the slice's direction, -1 against it
  // Lengths in the slice's plane are in units of the width of a pixel at the surface's depth.
  vec2 direction_px;      // outwards, unit; zero where there is nothing to search
  float unit;             // from scene units to that unit
  float radius;           // in that unit
  float slope;            // change of the tangent plane's inverse depth per pixel outwards
  float tangent_rise;     // y (times w) of the tangent plane per pixel outwards
  float rise_off_plane;   // y (times w) per unit of inverse depth off the tangent plane
  float tangent_cosine;   // cosine of the tangent plane's horizon
  float reach_px;         // from the first sample to the last; 0 where there is nothing to search
  float reach_per_step;   // reach_px over the squared number of steps
  float step_offset;      // of all samples, in steps, [0,1)
  float radius_px;        // the radius on the image
  float extrapolated_px;  // how far surfaces are extrapolated beyond the image's border
  float outside;          // the part of the radius that lies beyond the image's border, [0,1]
  ivec2 texel_bias;       // the shaded pixel less the bits of kRoundingBias
  vec2 height;            // gradient of the height over the tangent plane in the slice's plane
  float
      smallest_discontinuity;  // change of slope, in inverse depth per pixel, between two surfaces
  float depth_step;            // of the depth buffer there, as SliceSample::inverse_depth
  float nearness;              // radius by distance in perspective, else 0
  TangentPlane tangent;
};

// A float of this size has no fraction bits, so that adding it rounds to the nearest integer, which
// then stands in the low bits. One addition replaces a rounding and a conversion, which costs as
// much as four additions on GCN.
const float kRoundingBias = 12582912.0;  // 1.5 * 2^23
const int kRoundingBits = 0x4B400000;

// Smallest change of slope (depth difference divided by lateral distance) that counts as a
// discontinuity between two surfaces.
const float kDepthDiscontinuity = 4.0;

// Distances in pixels from `centre` to the border of the image, along `direction` and against it.
vec2 border_distances(vec2 centre, vec2 direction) {
  vec2 inverse = 1.0 / mix(direction, vec2(1e-9), equal(direction, vec2(0.0)));
  vec2 low = -centre * inverse;
  vec2 high = (vec2(size_px()) - centre) * inverse;
  vec2 along = max(low, high);
  vec2 against = min(low, high);
  return vec2(min(along.x, along.y), -max(against.x, against.y)) - 0.01;
}

// The part of the radius that lies beyond the image's border, [0,1].
float outside_share(float border_px, float radius_px) {
  return radius_px < kNearestStep ? 0.0 : max(1.0 - border_px / radius_px, 0.0);
}

// `border_px` is the distance to the border in the half-slice's direction, `radius_px` the radius
// on the image.
HalfSlice make_half_slice(Surface surface, SliceLine slice_line, Slice slice, float side,
                          float radius_px, float border_px, float step_offset) {
  HalfSlice half_slice;
  half_slice.side = side;
  half_slice.unit = 1.0 / max(slice_line.x_per_step, 1e-30);
  half_slice.radius = parameters.radius * half_slice.unit;
  vec2 direction_px = slice_line.direction_px * side;
  half_slice.tangent_cosine = tangent_horizon(slice, side);
  half_slice.radius_px = radius_px;
  // Where the surface faces away from a half-slice, what stands above its tangent plane within the
  // radius lies nearer by the cosine of gamma.
  float distance_px = half_slice.tangent_cosine > 0.0 ? radius_px * slice.cosine : radius_px;
  bool empty = min(distance_px, border_px) < kNearestStep;
  // Samples stay apart where the radius spans few pixels, and always inside the image.
  float apart_px = max(distance_px - kNearestStep, 0.25 * float(kStepCount));
  half_slice.reach_px = empty ? 0.0 : max(min(apart_px, border_px - kNearestStep), 1e-3);
  half_slice.reach_per_step = half_slice.reach_px * (1.0 / (float(kStepCount) * float(kStepCount)));
  half_slice.extrapolated_px =
      clamp(distance_px - border_px, 0.0, kExtrapolationRatio * half_slice.reach_px);
  half_slice.outside = outside_share(border_px, radius_px);
  // All samples of an empty half-slice are the shaded pixel: the first step may lie outside the
  // image.
  half_slice.direction_px = empty ? vec2(0.0) : direction_px;
  half_slice.step_offset = step_offset;
  half_slice.texel_bias = surface.pixel - kRoundingBits;
  half_slice.depth_step = surface.depth_step;
  half_slice.nearness = kPerspective ? parameters.radius * surface.tangent.inverse_depth : 0.0;
  half_slice.tangent = surface.tangent;
  half_slice.height = vec2(side * slice.along, slice.toward);
  half_slice.smallest_discontinuity = kDepthDiscontinuity * slice_line.x_per_step *
                                      (kPerspective ? surface.tangent.inverse_depth : 1.0);
  half_slice.slope = dot(direction_px, surface.tangent.gradient);
  half_slice.rise_off_plane =
      slice_line.y_per_depth * half_slice.unit * (kPerspective ? surface.depth : -1.0);
  half_slice.tangent_rise =
      side * slice_line.y_per_step * half_slice.unit + half_slice.slope * half_slice.rise_off_plane;
  return half_slice;
}

// Distance of sample `k` from the shaded pixel. The steps grow in proportion to it.
float sample_offset_px(HalfSlice half_slice, float k) {
  float steps = k + half_slice.step_offset;
  return steps * steps * half_slice.reach_per_step + kNearestStep;
}

// The point of the slice's plane `along_px` pixels outwards, `off_plane` off the tangent plane in
// inverse depth, as slice_point() of maths/slice_line.h gives it.
vec2 plane_point(HalfSlice half_slice, float along_px, float off_plane) {
  return vec2(along_px, along_px * half_slice.tangent_rise + off_plane * half_slice.rise_off_plane);
}

// Sample `k` of a layer of depth: 0 is the first, 1 the layer that it hides.
SliceSample fetch_sample(HalfSlice half_slice, uint layer, uint k) {
  SliceSample found;
  found.offset_px = sample_offset_px(half_slice, float(k));
  precise vec2 biased = half_slice.direction_px * found.offset_px + kRoundingBias;
  precise vec2 snapped = biased - kRoundingBias;
  ivec2 texel = floatBitsToInt(biased) + half_slice.texel_bias;
  found.inverse_depth = layer == 0u ? load_inverse_depth(texel)
                                    : inverse_depth_of(texelFetch(second_image, texel, 0).r);
  float along_px = kSnapToTexels ? dot(snapped, half_slice.direction_px) : found.offset_px;
  // Changes of the tangent plane's inverse depth from the shaded pixel to the texel and to the
  // line.
  float to_texel = dot(snapped, half_slice.tangent.gradient);
  float to_line = along_px * half_slice.slope;
  float off_plane = (found.inverse_depth - half_slice.tangent.inverse_depth) - to_texel;
  // A difference below the step of the depth buffer is not known to be one.
  off_plane -= clamp(off_plane, -half_slice.depth_step, half_slice.depth_step);
  bool on_plane = lies_on_tangent_plane(half_slice.tangent, off_plane, found.offset_px);
  found.off_plane = off_plane + (kSnapToTexels && on_plane ? 0.0 : to_texel - to_line);
  found.point = vec3(plane_point(half_slice, along_px, found.off_plane),
                     kPerspective ? found.inverse_depth : 1.0);
  if (kBackFaces) {
    float back = inverse_depth_of(texelFetch(back_image, texel, 0).r);
    // A back face is not taken to lie before the front face, which may have been moved.
    float front = half_slice.tangent.inverse_depth + to_line + found.off_plane;
    float end = farther_inverse_depth(front, back, kPerspective);
    found.back = ends_occluder(found.inverse_depth, back, kPerspective)
                     ? plane_point(half_slice, along_px, found.off_plane + (end - front))
                     : vec2(0.0, kNoBack);
  }
  return found;
}

// The thickness that the settings give an occluder at a sample, as slice_point() gives lengths
// (times w).
float settings_thickness(HalfSlice half_slice, SliceSample here) {
  // In perspective w times the distance is 1; an orthographic depth may lie behind the eye.
  float distance = kPerspective ? 1.0 : abs(here.inverse_depth);
  return parameters.thickness * half_slice.unit * (kThicknessOfDistance ? distance : here.point.z);
}

float squared_length(vec2 v) { return dot(v, v); }

// Whether a sample lies within the radius around the shaded point.
bool within_radius(HalfSlice half_slice, SliceSample here) {
  float radius = half_slice.radius * here.point.z;
  return squared_length(here.point.xy) <= radius * radius;
}

#endif
