// The search part of gtao.comp, which includes it: where the samples of one side of a slice lie,
// and what the depth buffer shows there.
#ifndef ALCOVE_GTAO_SEARCH_H
#define ALCOVE_GTAO_SEARCH_H

// Pixels from the surface to the border of the image along a direction.
float border_distance(vec2 centre, vec2 direction) {
  vec2 border = mix(vec2(0.0), vec2(size_px()), greaterThan(direction, vec2(0.0)));
  vec2 distance = (border - centre) / direction;
  return min(direction.x != 0.0 ? distance.x : 1e9, direction.y != 0.0 ? distance.y : 1e9) - 0.01;
}

// One side of a slice, as it is searched.
struct Search {
  ivec2 pixel;
  float side;             // 1, or -1 against the slice's direction
  SliceLine slice_line;   // outwards
  float reach_px;         // from the first step to the last; 0 where there is nothing to search
  float extrapolated_px;  // of the radius beyond the image's border, as far as surfaces go on there
  float outside;          // part of the radius beyond the image's border, [0,1]
  float offset;           // of the steps, [0,1)
  float depth;            // linear, of the shaded point
  float depth_step;       // of the depth buffer there, as SliceSample::inverse_depth
  TangentPlane tangent;
  float gradient;  // of the tangent line, outwards
  float lowest;    // cosine of the tangent plane's horizon
  // For sectors.
  vec2 height;              // above the tangent plane, of each unit of a point of the slice's plane
  float sharp;              // residual that parts two surfaces
  float per_diamond_angle;  // sectors
};

// Bend of the line between two samples, in depths for each pixel's width, that parts two surfaces.
const float kDepthDiscontinuity = 4.0;

Search make_search(Surface surface, SliceLine slice_line, Slice slice, float side, float offset) {
  Search search;
  search.pixel = surface.pixel;
  search.side = side;
  search.slice_line = slice_line;
  search.slice_line.direction_px *= side;
  search.slice_line.y_per_step *= side;
  // Where the surface faces away from a side, what stands above its tangent plane within the radius
  // lies nearer by the cosine of gamma.
  search.lowest = tangent_horizon(slice, side);
  float radius = parameters.radius * (search.lowest > 0.0 ? slice.cosine : 1.0);
  float distance_px = slice_radius_px(slice_line, radius, surface.depth, kPerspective);
  float border = border_distance(surface.centre, search.slice_line.direction_px);
  // Steps stay apart where the radius spans few pixels, and inside the image always.
  float apart = max(distance_px - kNearestStep, 0.25 * float(kStepCount));
  bool empty = min(distance_px, border) < kNearestStep;
  search.reach_px = empty ? 0.0 : max(min(apart, border - kNearestStep), 1e-3);
  search.extrapolated_px = clamp(distance_px - border, 0.0, kExtrapolationRatio * search.reach_px);
  search.outside = distance_px < kNearestStep ? 0.0 : max(1.0 - border / distance_px, 0.0);
  search.offset = offset;
  search.depth = surface.depth;
  search.depth_step = surface.depth_step;
  search.tangent = surface.tangent;
  search.gradient = dot(search.slice_line.direction_px, surface.tangent.gradient);
  search.height = vec2(side * slice.along, slice.toward);
  search.sharp = kDepthDiscontinuity * slice_line.x_per_step *
                 (kPerspective ? surface.tangent.inverse_depth : 1.0);
  search.per_diamond_angle = sectors_per_diamond_angle(slice, side);
  return search;
}

// The settings' thickness, of an occluder at a sample: as slice_point() gives lengths, times w.
float settings_thickness(SliceSample here) {
  // In perspective w times the distance is 1; an orthographic depth may lie behind the eye.
  float distance = kPerspective ? 1.0 : abs(here.inverse_depth);
  return parameters.thickness * (kThicknessOfDistance ? distance : here.point.z);
}

// Layers of depth: 0, and 1 behind it.
SliceSample fetch_sample(Search search, uint layer, uint k) {
  float t = (float(k) + search.offset) * (1.0 / float(kStepCount));
  SliceSample found;
  found.offset_px = kNearestStep + search.reach_px * (t * t);
  vec2 snapped = roundEven(search.slice_line.direction_px * found.offset_px);
  // A side with nothing to search may lie outside the image.
  ivec2 texel = search.pixel + (search.reach_px > 0.0 ? ivec2(snapped) : ivec2(0));
  float inverse_depth =
      layer == 0u ? imageLoad(inverse_depth_image, texel).r : imageLoad(second_image, texel).r;
  // Only across the line: along it a sample stays where it was found.
  float along_px = kSnapToTexels ? dot(snapped, search.slice_line.direction_px) : found.offset_px;
  float on_plane = dot(snapped, search.tangent.gradient);
  float off_plane = inverse_depth - search.tangent.inverse_depth - on_plane;
  // A difference below the step of the depth buffer is not known to be one.
  float rounding = clamp(off_plane, -search.depth_step, search.depth_step);
  inverse_depth -= rounding;
  float share = tangent_share(search.tangent, off_plane - rounding, found.offset_px);
  float moved = moved_inverse_depth(inverse_depth, share * (along_px * search.gradient - on_plane),
                                    kPerspective);
  found.inverse_depth = kSnapToTexels ? moved : inverse_depth;
  found.point =
      slice_point(search.slice_line, along_px, found.inverse_depth, search.depth, kPerspective);
  if (kBackFaces) {
    float back = imageLoad(back_image, texel).r;
    // Not before the front where that was moved.
    vec3 end = slice_point(search.slice_line, along_px,
                           farther_inverse_depth(found.inverse_depth, back, kPerspective),
                           search.depth, kPerspective);
    found.back = ends_occluder(inverse_depth, back, kPerspective) ? end.xy : vec2(0.0, kNoBack);
  }
  return found;
}

float squared_length(vec2 v) { return dot(v, v); }

#endif
