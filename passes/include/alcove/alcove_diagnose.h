// What a context says of the frames that it recorded: times, the plan, and mistakes of the engine.
// Included by alcove.h.
#ifndef ALCOVE_ALCOVE_DIAGNOSE_H_
#define ALCOVE_ALCOVE_DIAGNOSE_H_

#include <stddef.h>

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AlcoveTiming {
  char pass[ALCOVE_MAX_NAME];
  uint32_t view;  // AlcoveView::id
  double milliseconds;
} AlcoveTiming;

// The device time of each pass of the frame last recorded with `slot`, in order, after the device
// has finished it. With `timings` null, *count becomes the number of timings; else *count is the
// room in `timings` and becomes the number written. There are none without
// AlcoveContextInfo::timestamps.
AlcoveResult alcoveGetTimings(AlcoveContext* context, uint32_t slot, uint32_t* count,
                              AlcoveTiming* timings);

// Writes the plan of the last recorded frame as text: passes, barriers, memory. Buffer and result
// are as with alcovePrintSettings. Returns 0 if no such frame exists or there is no memory for the
// text.
size_t alcovePrintPlan(AlcoveContext* context, char* text, size_t size);

// Mistakes that show in the frames recorded so far: a line with a sentence for each, nothing where
// there is none. Ask after some dozens of frames in which the camera moved.
//
// Mistakes in the calls: an index that stands still, a previous_camera that is always this frame's
// or never the last one's, jitter in only one of the two, static_frames in motion, reset_history in
// every frame.
//
// Mistakes in the pixels, if at least three frames have AlcoveFrame::diagnose_pixels and all of
// them show the mistake: depth that runs the other way than the projection, a projection with depth
// from -1 to 1, normals that fit the depth only with another angle of view, in the other space,
// unpacked the other way, with the other sign of z or with y of the projection the other way round,
// a radius far out of proportion to the image, an image smaller than it is said to be, and a slot
// that is recorded again before its frame has finished. A wrong near plane alone scales the whole
// scene and cannot be seen.
//
// Buffer and result are as with alcovePrintSettings.
size_t alcoveDiagnose(AlcoveContext* context, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_DIAGNOSE_H_
