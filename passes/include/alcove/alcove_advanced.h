// Settings of Alcove that most engines never change: alternatives from the literature to compare
// with, filter tuning, and parts of the search that can be switched off to measure what they do.
// The defaults suit every scene. Use: alcoveGetAdvancedSettings, change a field, and let
// AlcoveSettings::advanced point to the struct.
#ifndef ALCOVE_ALCOVE_ADVANCED_H_
#define ALCOVE_ALCOVE_ADVANCED_H_

#include "alcove/alcove.h"

#ifdef __cplusplus
extern "C" {
#endif

// How thick occluders are taken to be. A depth buffer shows only their front faces.
typedef enum AlcoveEstimator {
  // Infinitely thick: the horizons of [Jimenez 2016].
  ALCOVE_ESTIMATOR_HORIZONS = 0,
  // The paper's thickness heuristic: lower samples further out lower a horizon.
  ALCOVE_ESTIMATOR_HEURISTIC = 1,
  // A visibility bitmask: each sample is an occluder of its own, as thick as `thickness` says.
  ALCOVE_ESTIMATOR_BITMASK = 2,
  // A bitmask in which neighbouring samples of one surface are connected without gaps. The default.
  // Suits thin objects and walls alike.
  ALCOVE_ESTIMATOR_CONNECTED = 3,
  ALCOVE_ESTIMATOR_MAX_ENUM = 0x7fffffff
} AlcoveEstimator;

// The weight of a visible direction in visibility. Bent normals always have the cosine's.
typedef enum AlcoveWeighting {
  ALCOVE_WEIGHTING_COSINE = 0,  // the cosine of its angle to the normal, as diffuse light needs it
  ALCOVE_WEIGHTING_UNIFORM =
      1,  // 1: visibility is the visible part of the hemisphere's solid angle
  ALCOVE_WEIGHTING_MAX_ENUM = 0x7fffffff
} AlcoveWeighting;

typedef enum AlcoveThicknessUnit {
  ALCOVE_THICKNESS_UNIT_RADIUS = 0,    // a fraction of the radius: constant in scene units
  ALCOVE_THICKNESS_UNIT_DISTANCE = 1,  // a fraction of the occluder's distance from the eye
  // Occluders end at AlcoveView::back_depth. At pixels where it has no face, RADIUS applies.
  ALCOVE_THICKNESS_UNIT_BACK_FACES = 2,
  ALCOVE_THICKNESS_UNIT_MAX_ENUM = 0x7fffffff
} AlcoveThicknessUnit;

// How slice directions are distributed over pixels and frames.
typedef enum AlcovePattern {
  ALCOVE_PATTERN_GOLDEN = 0,   // lattices without a period, rotated by the golden ratio
  ALCOVE_PATTERN_HILBERT = 1,  // the R2 sequence along a Hilbert curve
  ALCOVE_PATTERN_PAPER = 2,    // the 4x4 pixels and six rotations of [Jimenez 2016]
  ALCOVE_PATTERN_MAX_ENUM = 0x7fffffff
} AlcovePattern;

// Brackets hold the default of every quality but REFERENCE. A field that the estimator or the
// history does not use is not read, but it has to be in range.
typedef struct AlcoveAdvancedSettings {
  uint32_t struct_size;                // sizeof(AlcoveAdvancedSettings)
  AlcoveEstimator estimator;           // [CONNECTED]
  AlcoveWeighting weighting;           // [COSINE]
  AlcoveThicknessUnit thickness_unit;  // for BITMASK and CONNECTED [RADIUS]
  // How far a sample below the horizon lowers it: 0 not at all, 1 down to the sample. For
  // HEURISTIC. [0.05]
  float blend;
  // The last fraction of the radius, over which occluders fade out, 0 to 1, for HORIZONS and
  // HEURISTIC. Must be 0 with BITMASK and CONNECTED, whose sectors are either occluded or open. [0]
  float falloff;
  AlcovePattern pattern;  // [GOLDEN]
  // Filter radius in tiles for pixels with fewer than two frames of history, 0 to 3. Pixels with
  // more history use 1. 0 turns the filter off. [2]
  uint32_t filter_radius;
  // Distance from the pixel's tangent plane, in pixels, at which a neighbour's weight falls to
  // 0.25; above 0. It holds for one slice and no history, and shrinks with more samples. [1.5]
  float filter_tolerance_px;
  // The history is clamped to the mean of this frame's neighbourhood plus or minus so many standard
  // deviations, at least 0. 0 does not clamp. [0]
  float clamp_width;

  // Parts of the search that can be switched off to measure what they do.

  // Snaps samples to texel centres. Without it, tilted planes occlude themselves. [true]
  VkBool32 snap_to_texels;
  VkBool32 extrapolation;  // extrapolates surfaces beyond the image's border, for CONNECTED [true]
  // Leaves directions that the depth buffer does not show (behind a foreground, or beyond the
  // image's border) partly out of the average. If off, they count as open. For CONNECTED. [true]
  VkBool32 unobserved;
} AlcoveAdvancedSettings;

// Fills `settings`, whose struct_size is set, with the advanced settings of a preset: the defaults,
// except for REFERENCE. ALCOVE_ERROR_INVALID_INPUT if an argument is invalid.
AlcoveResult alcoveGetAdvancedSettings(AlcoveQuality quality, AlcoveAdvancedSettings* settings);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_ADVANCED_H_
