// Reports of a context on the frames that it recorded: times, the plan, and mistakes of the engine.
// Included by alcove.h.
#ifndef ALCOVE_ALCOVE_DIAGNOSE_H_
#define ALCOVE_ALCOVE_DIAGNOSE_H_

#include <stddef.h>

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

// The time that the device took for a pass.
typedef struct AlcoveTiming {
  char pass[ALCOVE_MAX_NAME];
  uint32_t view;  // AlcoveView::id
  double milliseconds;
} AlcoveTiming;

// Returns the device time of each pass of the last frame that was recorded with `slot`, in order.
// Call it after the device has finished that frame. If `timings` is null, *count becomes the number
// of timings. Otherwise *count is the number of timings that `timings` has room for, and becomes
// the number written. There are none if AlcoveContextInfo::timestamps is false.
AlcoveResult alcoveGetTimings(AlcoveContext* context, uint32_t slot, uint32_t* count,
                              AlcoveTiming* timings);

// Writes the plan of the last recorded frame as text: passes, barriers and memory. `text`, `size`
// and the result are as in alcovePrintSettings. Returns 0 if there is no such frame, or not enough
// memory for the text.
size_t alcovePrintPlan(AlcoveContext* context, char* text, size_t size);

// Writes a line with a sentence for each mistake of the engine that most of the last eight frames
// show that could show it, or an empty text if there is none. Call it after a dozen frames in which
// the camera moved, and at any later time: a mistake is named whenever it begins, and no longer
// once it has been mended. `text`, `size` and the result are as in alcovePrintSettings.
//
// Some mistakes show in the calls: an index that stays the same or goes back, a wrong
// previous_camera or previous size, jitter in only one of the two cameras, static_frames that are
// not 0 although the image changes, reset_history in every frame, and views that are never dropped.
// A sentence in the log tells of the last one, too.
//
// Other mistakes show in the pixels, in frames with AlcoveFrame::diagnose_pixels, if depth has one
// sample per pixel:
// - in depth: another range, direction or format than stated, another size of the image, dynamic
//   resolution without a largest size, and a radius that is far too small or too large;
// - in depth and normals: another angle of view, other near and far planes, the other sign of y,
//   normals in another space or encoding or with the other sign of z, an inverted view_from_world,
//   and normals that fit depth under no reading;
// - from frame to frame: a camera or a depth image of another frame, jitter that is missing or of
//   another sign or unit, a view_from_world without translation or in another unit, a near plane
//   that scales the whole scene, cameras that do not fit the depth of most pixels, motion vectors
//   of another sign, unit or jitter or that lack the camera's motion, and a slot that is recorded
//   again before its frame has finished.
//
// These mistakes do not show: a camera that is one frame late, if it moves evenly and without
// jitter, because successive cameras are then the same; a near plane or a view_from_world in
// another unit while the camera does not move, or if all that is seen is one plane; another angle
// of view if almost every surface is parallel or perpendicular to the view axis and the camera does
// not move; motion vectors of moving objects, as long as those of static surfaces are right; a
// depth image that is always empty, which looks like the sky; and the contents of roughness,
// albedo, back_depth and second_depth.
size_t alcoveDiagnose(AlcoveContext* context, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_DIAGNOSE_H_
