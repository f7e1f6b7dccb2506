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
  uint32_t view;  // AlcoveViewInfo::id
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
// Mistakes in the calls are judged in every frame: indices, previous cameras and sizes, jitter in
// only one of two cameras, static_frames, reset_history, and views that are never dropped. Mistakes
// in the pixels are judged in frames with AlcoveFrame::diagnose_pixels, if depth has one sample per
// pixel: depth, normals, radius, cameras and motion vectors. passes/INTEGRATION.md lists all, and
// those that do not show.
size_t alcoveDiagnose(AlcoveContext* context, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_DIAGNOSE_H_
