// The function of c_program.c, which is compiled as C99 to show that the C interface works from C.
#pragma once

#include "alcove/alcove.h"

#ifdef __cplusplus
extern "C" {
#endif

// Creates a context and records one frame of visibility into `commands`. Writes the memory of the
// frame, or the error message, to `text`, which has room for `size` bytes. `context` receives the
// context, which the caller destroys.
AlcoveResult run_c_program(const AlcoveContextInfo* info, const AlcoveCamera* camera,
                           const AlcoveImage* depth, const AlcoveImage* visibility,
                           VkCommandBuffer commands, AlcoveContext** context, char* text,
                           size_t size);

#ifdef __cplusplus
}
#endif
