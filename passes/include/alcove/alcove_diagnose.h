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

// Writes a line with a sentence for each mistake of the engine that shows in the frames recorded so
// far, or an empty text if there is none. Call it after some dozens of frames in which the camera
// moved. `text`, `size` and the result are as in alcovePrintSettings.
//
// Some mistakes show in the calls: an index that stays the same, a previous_camera that is always
// this frame's or never the last frame's, jitter in only one of the two cameras, static_frames that
// are not 0 although the camera moves, and reset_history in every frame.
//
// Other mistakes show in the pixels, if at least three frames had AlcoveFrame::diagnose_pixels and
// all of them show the mistake: depth that runs in the opposite direction to that of the
// projection; a projection with depth from -1 to 1; normals that fit the depth only with another
// angle of view or other near and far planes, in the other space, unpacked in the other way, with
// the other sign of z, or with the other sign of y of the projection; a radius that is far too
// small or too large for the image; an image that is smaller than it is said to be; and a slot that
// is recorded again before its frame has finished.
//
// These mistakes do not show: an infinite projection with a wrong near plane, which scales the
// whole scene; a wrong angle of view if almost every surface is parallel or perpendicular to the
// view axis, because the scene is then only stretched across that axis, and its normals stay as
// they are; jitter that is in neither camera; and motion vectors with the wrong sign or unit.
size_t alcoveDiagnose(AlcoveContext* context, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_DIAGNOSE_H_
