// The spatial filter of reconstruct.comp: weighted sums over the traced pixels around a pixel.
#ifndef ALCOVE_RECONSTRUCT_FILTER_H
#define ALCOVE_RECONSTRUCT_FILTER_H

// Number of traced pixels on each side that are averaged for a pixel with a history.
const int kNearRadius = kFilterRadius == 0 ? 0 : 1;

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
  float inverse_squared_width;  // ReconstructParameters::inverse_squared_window
  // At least 1: the square of the factor on distances from the tangent plane.
  float squared_plane_factor;
};

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

// Adds the traced pixel that lies `i` tiles to the right of the first one and `j` tiles below it.
// Its weight falls with the distance on the image, with the distance from the tangent plane and
// with the angle between the normals, but never to zero: if no neighbour lies on the plane, the
// nearest to it count most.
void add_traced(inout Sums sums, Surface surface, Window window, int i, int j) {
  vec2 offset = vec2(traced_offset(surface.around, 0, i), traced_offset(surface.around, 1, j));
  int index = surface.around.first_tile + j * kSpan + i;
  vec4 found = traced[index];
  float expected = surface.plane.z + offset.y * surface.plane.y + offset.x * surface.plane.x;
  float off_plane = min(abs(found.x * surface.per_inverse_depth - expected), kFarthestOffPlane);
  float near = 1.0 + (offset.y * offset.y + offset.x * offset.x) * window.inverse_squared_width;
  float level = 1.0 + off_plane * off_plane * window.squared_plane_factor;
  if (kByNormal) {
    vec2 other = vec2(found.w, traced_stereographic_y[index]);
    level += min(squared_angle(surface.stereographic, other), kLargestSquaredAngle);
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

// Indices of the first traced pixels within the two radii.
const int kFirstNear = kBetween ? 1 - kNearRadius : -kNearRadius;
const int kFirstWide = kBetween ? 1 - kFilterRadius : -kFilterRadius;

bool is_near(int i, int j) { return min(i, j) >= kFirstNear && max(i, j) <= kNearRadius; }

bool is_corner(int i, int j) {
  return kFilterRadius > 1 && (i == kFirstWide || i == kFilterRadius) &&
         (j == kFirstWide || j == kFilterRadius);
}

// Returns the sums over the traced pixels within kNearRadius.
Sums sum_near(Surface surface, Window window) {
  Sums sums = no_sums();
  [[unroll]] for (int j = kFirstNear; j <= kNearRadius; ++j) {
    [[unroll]] for (int i = kFirstNear; i <= kNearRadius; ++i) {
      add_traced(sums, surface, window, i, j);
    }
  }
  return sums;
}

// Returns the sums over the traced pixels within kFilterRadius, without the corners. The loops are
// unrolled, because every pixel of a first frame runs them.
Sums sum_wide(Surface surface, Window window) {
  Sums sums = no_sums();
  [[unroll]] for (int j = kFirstWide; j <= kFilterRadius; ++j) {
    [[unroll]] for (int i = kFirstWide; i <= kFilterRadius; ++i) {
      if (!is_corner(i, j)) {
        add_traced(sums, surface, window, i, j);
      }
    }
  }
  return sums;
}

// Adds to sum_near() what sum_wide() sums in addition.
void add_ring(inout Sums sums, Surface surface, Window window) {
  [[dont_unroll]] for (int j = kFirstWide; j <= kFilterRadius; ++j) {
    [[dont_unroll]] for (int i = kFirstWide; i <= kFilterRadius; ++i) {
      if (!is_corner(i, j) && !is_near(i, j)) {
        add_traced(sums, surface, window, i, j);
      }
    }
  }
}

#endif
