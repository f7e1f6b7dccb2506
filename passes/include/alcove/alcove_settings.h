// The settings of a view and their presets. Included by alcove.h. It needs no header of Vulkan.
#ifndef ALCOVE_ALCOVE_SETTINGS_H_
#define ALCOVE_ALCOVE_SETTINGS_H_

#include <stddef.h>

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

// Presets for alcoveGetSettings. A field that is not in the table has the default that
// AlcoveSettings states. There are three exceptions: CONSOLE sets half_resolution, ULTRA sets
// depth_layers to 2, and HEIGHT_FIELD sets precision FLOAT32 and the paper's estimator HORIZONS.
//
//              slices  steps  tile_size  history_frames  depth fetches per pixel and frame
//   CONSOLE         1     10        8              32                                0.31
//   LOW             1      8        4              32                                1
//   MEDIUM          2     12        4              32                                3
//   HIGH            2     12        2              32                               12
//   ULTRA           2     10        2              32                               20
//   HEIGHT_FIELD   32     64        1               0                             4096
typedef enum AlcoveQuality {
  ALCOVE_QUALITY_CONSOLE = 0,  // traces one of 8x8 pixels in each frame, filters at half resolution
  ALCOVE_QUALITY_LOW = 1,      // traces one of 4x4 pixels in each frame
  ALCOVE_QUALITY_MEDIUM = 2,   // LOW with two slices and more steps; the preset to begin with
  ALCOVE_QUALITY_HIGH = 3,     // traces one of 2x2 pixels in each frame
  // HIGH with 10 steps in each of two depth layers. A view without the image
  // ALCOVE_IMAGE_SECOND_DEPTH then fails with a sentence; set depth_layers to 1, or choose HIGH.
  ALCOVE_QUALITY_ULTRA = 4,
  // The exact integral over the depth buffer, with occluders of infinite thickness: a static image
  // to compare with. Its error against ray-traced truth exceeds that of MEDIUM where objects are
  // thin.
  ALCOVE_QUALITY_HEIGHT_FIELD = 5,
  ALCOVE_QUALITY_MAX_ENUM = 0x7fffffff
} AlcoveQuality;

// Estimators of occlusion: they differ in how thick they assume occluders to be, because a depth
// buffer shows only the front faces of occluders.
typedef enum AlcoveEstimator {
  // Occluders are infinitely thick. The horizon search of [Jimenez 2016].
  ALCOVE_ESTIMATOR_HORIZONS = 0,
  // A visibility bitmask in which consecutive samples of one surface are connected, so that no
  // light passes between them. It is the default, and suits both thin objects and walls.
  ALCOVE_ESTIMATOR_CONNECTED = 1,
  ALCOVE_ESTIMATOR_MAX_ENUM = 0x7fffffff
} AlcoveEstimator;

// How visibility weights the directions of the hemisphere. Bent normals always use COSINE, and
// multi-bounce and the specular model TABLE expect it.
typedef enum AlcoveWeighting {
  // By the cosine of the angle to the normal, as diffuse reflection needs it.
  ALCOVE_WEIGHTING_COSINE = 0,
  // All alike: visibility is the visible fraction of the hemisphere's solid angle ([Jimenez 2016],
  // appendix A), as older effects have it.
  ALCOVE_WEIGHTING_UNIFORM = 1,
  ALCOVE_WEIGHTING_MAX_ENUM = 0x7fffffff
} AlcoveWeighting;

// What limits the thickness of occluders.
typedef enum AlcoveThicknessLimit {
  // AlcoveSettings::thickness, in radii.
  ALCOVE_THICKNESS_LIMIT_RADIUS = 0,
  // The back faces in ALCOVE_IMAGE_BACK_DEPTH, at which occluders end. At pixels without a back
  // face the thickness is that of RADIUS.
  ALCOVE_THICKNESS_LIMIT_BACK_FACES = 1,
  ALCOVE_THICKNESS_LIMIT_MAX_ENUM = 0x7fffffff
} AlcoveThicknessLimit;

// How specular occlusion is computed, if a view has the image ALCOVE_IMAGE_SPECULAR.
typedef enum AlcoveSpecular {
  ALCOVE_SPECULAR_NONE = 0,  // not at all: a view with that image is refused
  // Integrates the GGX lobe over the slices that visibility is computed from: the most exact.
  ALCOVE_SPECULAR_SLICES = 1,
  // The GGX lobe within a cone around the bent normal, by a table of 54 KiB. Visibility and the
  // bent normal are then computed too.
  ALCOVE_SPECULAR_TABLE = 2,
  ALCOVE_SPECULAR_MAX_ENUM = 0x7fffffff
} AlcoveSpecular;

// The precision of intermediate results that have no image of the engine. Images have their own.
typedef enum AlcovePrecision {
  ALCOVE_PRECISION_UNORM8 = 0,   // 8 bits a channel
  ALCOVE_PRECISION_FLOAT16 = 1,  // half floats
  ALCOVE_PRECISION_FLOAT32 = 2,  // floats
  ALCOVE_PRECISION_MAX_ENUM = 0x7fffffff
} AlcovePrecision;

// The settings of a view. Fill the struct with alcoveGetSettings, then change individual fields.
// Values in square brackets are the defaults of all qualities but HEIGHT_FIELD, if not said
// otherwise. If a value is out of range, the call fails with ALCOVE_ERROR_INVALID_INPUT, and
// alcoveGetMessage names the field and its range.
typedef struct AlcoveSettings {
  uint32_t struct_size;  // sizeof(AlcoveSettings)
  // The largest distance at which occluders count, in scene units, above 0. A twentieth to a fifth
  // of a room's height is usual.
  float radius;
  // Width of a tile in pixels: 1, 2, 4 or 8. In each frame, one pixel of each tile is traced
  // (searched for occluders). Another pixel of the tile is traced in the next frame, so that each
  // is traced once in tile_size^2 frames.
  uint32_t tile_size;
  // Slices of a traced pixel, 1 to 64. A slice is a plane through the view direction, in which
  // depth is sampled in both directions. Raising it reduces noise, and raises the cost in
  // proportion.
  uint32_t slices;
  // Samples in each of the two directions of a slice, 2 to 64. More find thinner occluders. A
  // traced pixel costs 2 * slices * steps * depth_layers depth fetches.
  uint32_t steps;
  AlcoveEstimator estimator;  // [CONNECTED]
  AlcoveWeighting weighting;  // read by HORIZONS [COSINE]
  // The thickness of occluders as a fraction of the radius, at least 0. It is an upper limit: an
  // occluder is no thicker than it is seen to be wide. Read by CONNECTED, as are the next three.
  // [0.3]
  float thickness;
  AlcoveThicknessLimit thickness_limit;  // [RADIUS]
  // The average fraction of the volume hidden behind occluders that is treated as solid, 0 to 1.
  // The actual fraction grows with the occluder's width in the image: it is larger behind a wall
  // than behind a twig. [0.286]
  float hidden_occlusion;
  uint32_t depth_layers;  // the depth layers that are searched: 1, or 2 with
                          // ALCOVE_IMAGE_SECOND_DEPTH [1, but 2 for ULTRA]
  // The largest number of frames that the history averages, 0 to 127. Raising it reduces noise, and
  // lets the image follow changes more slowly. After 16 frames without a change (static_frames) the
  // limit is 127. With 0 there is no history, and no memory for one.
  uint32_t history_frames;
  // Whether every frame has the same noise, so that equal inputs give equal outputs and
  // AlcoveFrame::index is not read. Set it without any temporal filter: with history_frames = 0 the
  // noise would otherwise change in every frame and never be averaged. It has no effect with a
  // history, which needs changing noise. [0]
  uint32_t static_noise;
  // Whether the passes filter and accumulate texels of 2x2 pixels and then upsample the result
  // along depth edges. This takes less time and less memory for the history, and has a larger
  // error. It needs a tile_size of at least 2. [0, but 1 for CONSOLE]
  uint32_t half_resolution;
  AlcoveSpecular specular;     // read if ALCOVE_IMAGE_SPECULAR is given [SLICES]
  float roughness;             // perceptual, 0 to 1, without ALCOVE_IMAGE_ROUGHNESS [0.5]
  uint32_t roughness_channel;  // the channel of ALCOVE_IMAGE_ROUGHNESS, 0 to 3 [0]
  AlcovePrecision precision;   // of intermediate results [UNORM8]
  // The passes write the visibility 1 - intensity * (1 - visibility^power), clamped to [0,1]. If
  // both values are 1, visibility is unchanged and the shaders skip the computation. Multi-bounce
  // and the specular model TABLE read the changed visibility.
  float power;      // above 0, at most 16 [1]
  float intensity;  // 0 to 16 [1]
} AlcoveSettings;

// Fills `settings`, whose struct_size must be set, with a preset. `radius` is in scene units and
// above 0. Returns ALCOVE_ERROR_INVALID_INPUT if an argument is invalid; there is no message,
// because there is no context.
AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings);

// Writes the settings to `text` as lines of `name = value`. At most `size` bytes are written,
// including the terminating zero. A float is written as the shortest text that reads back as the
// same float, in every locale. Returns the number of bytes of the whole text without that zero, or
// 0 if the settings are invalid. `text` may be null if `size` is 0.
size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size);

// Changes the settings that a text names. `text` holds `length` bytes: lines of `name = value`, as
// alcovePrintSettings and `alcove recommend --out` write them. Empty lines, and lines that
// begin with `#`, are skipped. `settings` must have been filled before, for example by
// alcoveGetSettings. Reads no file and allocates nothing that grows with the text.
//
// If a line has another form, an unknown name or a value that the setting does not allow, nothing
// is changed and ALCOVE_ERROR_INVALID_INPUT is returned. If `message` is not null, it must have
// room for ALCOVE_MAX_MESSAGE bytes, and receives a sentence, or an empty text if there is no
// error.
AlcoveResult alcoveReadSettings(const char* text, size_t length, AlcoveSettings* settings,
                                char* message);

// A still image, such as a screenshot or a thumbnail, takes several frames of a scene and a camera
// that do not move. Returns how many frames these settings need until their image has converged:
// 128 with a history, which is then full, and 1 with history_frames = 0 and static_noise. Returns 0
// if the settings are invalid, or if an image never converges because noise changes from frame to
// frame and there is no history. Fewer frames have a larger error; INTEGRATION.md has figures.
uint32_t alcoveGetConvergedFrames(const AlcoveSettings* settings);

// The limits of alcoveFitBudget.
typedef struct AlcoveBudget {
  uint32_t struct_size;   // sizeof(AlcoveBudget)
  double target_ms;       // wanted time of the passes of a view in milliseconds, above 0
  uint32_t least_slices;  // 1 to 64
  uint32_t most_slices;   // least_slices to 64
  uint32_t least_steps;   // 2 to 64
  uint32_t most_steps;    // least_steps to 64
} AlcoveBudget;

// Changes `slices` and `steps` of `settings` so that the passes take about target_ms, and at most
// that if the limits allow it. `milliseconds` holds the measured times of the last `count` frames
// that were drawn with these settings, the newest last (the sum of alcoveGetTimings over the passes
// of the view). Sets *changed to whether the settings have changed: the caller then drops the times
// that it has collected. The function is pure: equal arguments give equal results.
//
// It judges by the median of the last 32 times. Times that are not finite or not above 0 do not
// count, and fewer than 8 times change nothing. It lowers the settings if the median is above the
// target, and raises them if it expects at most 0.9 of the target afterwards, so that times that
// scatter by less than a tenth change nothing. It assumes that the time grows at most in proportion
// to slices * (steps + 4); as the filter's time does not depend on either, it approaches the target
// in several calls and does not oscillate. Steps are raised before slices. Settings outside of the
// limits are moved into them.
//
// Each combination of slices and steps has pipelines of its own. Call alcovePrepareFrame with the
// new settings, on another thread if frames must not wait.
AlcoveResult alcoveFitBudget(const AlcoveBudget* budget, const double* milliseconds, uint32_t count,
                             AlcoveSettings* settings, uint32_t* changed);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_SETTINGS_H_
