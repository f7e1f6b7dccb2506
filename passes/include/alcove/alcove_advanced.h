// Settings of Alcove that most engines never change: other estimators from the literature, filter
// parameters, and switches that turn off parts of the search, so that their effect can be measured.
// The defaults suit every scene. To use them, fill a struct with alcoveGetAdvancedSettings, change
// fields, and let AlcoveSettings::advanced point to it.
#ifndef ALCOVE_ALCOVE_ADVANCED_H_
#define ALCOVE_ALCOVE_ADVANCED_H_

#include "alcove/alcove_settings.h"

#ifdef __cplusplus
extern "C" {
#endif

// Estimators of occlusion: they differ in how thick they assume occluders to be, because a depth
// buffer shows only the front faces of occluders.
typedef enum AlcoveEstimator {
  // Occluders are infinitely thick. The horizon search of [Jimenez 2016].
  ALCOVE_ESTIMATOR_HORIZONS = 0,
  // A visibility bitmask. Each sample is a separate occluder with the thickness
  // AlcoveSettings::thickness.
  ALCOVE_ESTIMATOR_BITMASK = 1,
  // A visibility bitmask in which consecutive samples of one surface are connected, so that no
  // light passes between them. It is the default, and suits both thin objects and walls.
  ALCOVE_ESTIMATOR_CONNECTED = 2,
  ALCOVE_ESTIMATOR_MAX_ENUM = 0x7fffffff
} AlcoveEstimator;

// The unit of AlcoveSettings::thickness.
typedef enum AlcoveThicknessUnit {
  // The radius: the thickness of occluders is constant in scene units.
  ALCOVE_THICKNESS_UNIT_RADIUS = 0,
  // The occluder's depth along the view axis: distant occluders are thicker.
  ALCOVE_THICKNESS_UNIT_DISTANCE = 1,
  // Occluders end at the back faces in AlcoveView::back_depth. At pixels without a back face the
  // thickness is that of RADIUS.
  ALCOVE_THICKNESS_UNIT_BACK_FACES = 2,
  ALCOVE_THICKNESS_UNIT_MAX_ENUM = 0x7fffffff
} AlcoveThicknessUnit;

// Advanced settings. Values in square brackets are the defaults of all qualities except REFERENCE.
// A field that the chosen estimator does not use has no effect, but must still be in range.
typedef struct AlcoveAdvancedSettings {
  uint32_t struct_size;                // sizeof(AlcoveAdvancedSettings)
  AlcoveEstimator estimator;           // [CONNECTED]
  AlcoveThicknessUnit thickness_unit;  // read by BITMASK and CONNECTED [RADIUS]
  // The outermost part of the radius, as a fraction of it from 0 to 1, over which occluders fade
  // out. Read by HORIZONS. It must be 0 with BITMASK and CONNECTED, whose sectors are
  // either occluded or not. [0]
  float falloff;
  // Radius of the spatial filter in tiles, 0 to 3, for pixels with fewer than two frames of
  // history. Pixels with more history use a radius of 1. 0 turns the filter off for all pixels. [2]
  uint32_t filter_radius;
  // The distance of a neighbour from the pixel's tangent plane at which the filter gives it a
  // quarter of the full weight, in units of a pixel's width at its depth; above 0. The value is for
  // one slice and no history; more slices and more history reduce the distance. [1.5]
  float filter_tolerance_px;

  // Parts of the search that can be switched off, so that their effect can be measured.

  // Whether each sample is moved to the centre of its depth texel. If off, tilted planes occlude
  // themselves. [true]
  uint32_t snap_to_texels;
  // Whether surfaces that leave the image are extrapolated beyond its border, where they can
  // occlude. If off, nothing beyond the border occludes. Read by CONNECTED. [true]
  uint32_t extrapolation;
  // Whether directions that the depth buffer does not show are partly excluded from the average.
  // These are directions hidden behind a foreground or beyond the border of the image. If off, they
  // count as unoccluded. Read by CONNECTED. [true]
  uint32_t unobserved;
} AlcoveAdvancedSettings;

// Fills `settings`, whose struct_size must be set, with the advanced settings of a preset. They are
// the defaults, except for REFERENCE. Returns ALCOVE_ERROR_INVALID_INPUT if an argument is invalid.
AlcoveResult alcoveGetAdvancedSettings(AlcoveQuality quality, AlcoveAdvancedSettings* settings);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_ADVANCED_H_
