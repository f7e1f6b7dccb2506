// The spatial filter of reconstruct.comp: weighted sums over the traced pixels around a pixel.
#ifndef ALCOVE_RECONSTRUCT_FILTER_H
#define ALCOVE_RECONSTRUCT_FILTER_H

#include "maths/quantised_normal.h"
#include "reconstruct_surface.h"
#include "reconstruct_tiles.h"

// Upper bound of the squared angle between normals in a neighbour's weight. The factor of the
// weight that depends on the angle is then at least 1 / (1 + 1.23)^2 = 0.2, because a neighbour
// across a crease is better than none where a pixel has few other neighbours. Fitted to the error
// of first frames (`alcove compare --frames 1`).
const float kLargestSquaredAngle = 1.23;

// The distance from the tangent plane, in units of the tolerance, beyond which a weight no longer
// falls. It keeps weights from becoming denormal numbers.
const float kFarthestOffPlane = 1e7;

// How weights fall with distance.
struct Window {
  // In sum_near() between traced pixels, the weight along an axis is max(1 - sharpness d^2, 0)^2 at
  // a distance of d pixels. In other sums it is 1 / (1 + inverse_squared_width d^2)^4, where
  // inverse_squared_width is `sharpness` times parameters.wide_sharpness.
  float sharpness;
  // At least 1: the square of the factor on distances from the tangent plane.
  float squared_plane_factor;
};

// Weighted sums over traced pixels.
struct Sums {
  float occluded;
  float open;
  vec3 residual;
  vec3 expected_residual;
  vec2 lobe;  // occluded, open
};

Sums no_sums() { return Sums(0.0, 0.0, vec3(0.0), vec3(0.0), vec2(0.0)); }

void add_weighted(inout Sums sums, TileSample found, float weight, LobeSurface lobe) {
  sums.occluded += weight * found.occluded;
  sums.open += weight * found.open;
  if (kBentNormal) {
    sums.residual += weight * found.residual;
    sums.expected_residual += weight * found.expected_residual;
  }
  if (kLobe) sums.lobe += weight * lobe_weight(lobe, found.lobe_surface) * found.lobe;
}

// Returns the offset, in pixels, to the traced pixel that lies `i` tiles to the right of the first
// one (axis 0) or below it (axis 1). Beyond the border of the image it is that of the last pixel
// that is traced.
float traced_offset(Place place, int axis, int i) {
  vec2 range = vec2(parameters.traced_range[axis], parameters.traced_range[axis + 2]) + 0.5 -
               place.centre[axis];
  return clamp(place.around.offset[axis] + float(i * kTileSize), range.x, range.y);
}

// Adds the traced pixel `found` that lies `i` tiles to the right of the first one and `j` tiles
// below it. Its weight falls with the distance on the image, with the distance from the tangent
// plane and with the angle between the normals, but never to zero: if no neighbour lies on the
// plane, the nearest to it count most.
void add_tile_sample(inout Sums sums, Surface surface, Window window, TileSample found, int i,
                     int j) {
  vec2 offset = vec2(traced_offset(surface.place, 0, i), traced_offset(surface.place, 1, j));
  float expected = surface.plane.z + offset.y * surface.plane.y + offset.x * surface.plane.x;
  float off_plane =
      min(abs(found.inverse_depth * surface.per_inverse_depth - expected), kFarthestOffPlane);
  float near = 1.0 + (offset.y * offset.y + offset.x * offset.x) *
                         (window.sharpness * parameters.wide_sharpness);
  float level = 1.0 + off_plane * off_plane * window.squared_plane_factor;
  if (kByNormal)
    level += min(squared_angle(surface.stereographic, found.stereographic), kLargestSquaredAngle);
  float both = near * near * level;
  float weight = 1.0 / (both * both);
  add_weighted(sums, found, weight, surface.lobe);
}

// Indices of the first traced pixels within the two radii.
const int kFirstNear = kBetween ? 1 - kNearRadius : -kNearRadius;
const int kFirstWide = kBetween ? 1 - kFilterRadius : -kFilterRadius;

bool is_corner(int i, int j) {
  return kFilterRadius > 1 && (i == kFirstWide || i == kFilterRadius) &&
         (j == kFirstWide || j == kFilterRadius);
}

// Adds up the four traced pixels around a texel, from shared memory. Their weights fall to zero at
// a finite distance, which needs no division.
Sums sum_four(Surface surface, Window window) {
  Sums sums = no_sums();
  TracedPixels around = surface.place.around;
  vec4 offsets = vec4(around.offset, around.offset + float(kTileSize));  // x, y, x, y
  vec4 near = clamp(1.0 - offsets * (offsets * window.sharpness), 0.0, 1.0);
  float half_factor = 0.5 * window.squared_plane_factor;
  [[unroll]] for (int j = 0; j < 2; ++j) {
    float expected = surface.plane.z + offsets[2 * j + 1] * surface.plane.y;
    [[unroll]] for (int i = 0; i < 2; ++i) {
      TileSample found = load_shared(around.first_tile + j * kSpan + i);
      float off_plane = found.inverse_depth * surface.per_inverse_depth -
                        (expected + offsets[2 * i] * surface.plane.x);
      float root = 1.0 - off_plane * (off_plane * half_factor);
      if (kByNormal) {
        root -= 0.5 * min(squared_angle(surface.stereographic, found.stereographic),
                          kLargestSquaredAngle);
      }
      root = clamp(root, 0.0, 1.0);
      float weight = root * (near[2 * i] * near[2 * j + 1]);  // its root
      add_weighted(sums, found, weight * weight, surface.lobe);
    }
  }
  return sums;
}

// Returns the sums over the traced pixels within kNearRadius.
Sums sum_near(Surface surface, Window window) {
  if (kBetween) return sum_four(surface, window);
  Sums sums = no_sums();
  [[unroll]] for (int j = kFirstNear; j <= kNearRadius; ++j) {
    [[unroll]] for (int i = kFirstNear; i <= kNearRadius; ++i) {
      int index = surface.place.around.first_tile + j * kSpan + i;
      add_tile_sample(sums, surface, window, load_shared(index), i, j);
    }
  }
  return sums;
}

// A sum over traced pixels is to be multiplied by this, by the area of a tile and by the sharpness
// or the inverse squared width of its window. The mean over pixels of the sums of weights is then
// about 1 for every window and tile size.
const float kWideScale = 1.3;
float near_scale() { return mix(kWideScale, 1.195, kBetween); }

// Returns the sums over the traced pixels within kFilterRadius, without the corners, on the scale
// of sum_near(). If there is a history, few texels run this, and they read the traced pixels from
// the image.
Sums sum_wide(Surface surface, Window window) {
  Sums sums = no_sums();
  if (kFresh) {
    [[unroll]] for (int j = kFirstWide; j <= kFilterRadius; ++j) {
      [[unroll]] for (int i = kFirstWide; i <= kFilterRadius; ++i) {
        if (!is_corner(i, j)) {
          int index = surface.place.around.first_tile + j * kSpan + i;
          add_tile_sample(sums, surface, window, load_shared(index), i, j);
        }
      }
    }
  } else {
    ivec2 first = cell_of(surface.place.texel * kTexelSize);
    [[dont_unroll]] for (int j = kFirstWide; j <= kFilterRadius; ++j) {
      [[dont_unroll]] for (int i = kFirstWide; i <= kFilterRadius; ++i) {
        if (!is_corner(i, j)) {
          ivec2 tile = clamp(first + ivec2(i, j), ivec2(0), last_tile());
          add_tile_sample(sums, surface, window, fetch_tile_sample(tile), i, j);
        }
      }
    }
  }
  float scale = kWideScale / near_scale() * parameters.wide_sharpness;
  sums.occluded *= scale;
  sums.open *= scale;
  sums.residual *= scale;
  sums.expected_residual *= scale;
  sums.lobe *= scale;
  return sums;
}

#endif
