// What c_program.c, compiled as C99, does.
#pragma once

#include "alcove/alcove.h"

#ifdef __cplusplus
extern "C" {
#endif

// Records one frame of visibility from depth into `commands`, prints what it costs into `text` (of
// `size` bytes) and gives the context back.
AlcoveResult run_c_program(const AlcoveContextInfo* info, const AlcoveCamera* camera,
                           const AlcoveImage* depth, const AlcoveImage* visibility,
                           VkCommandBuffer commands, AlcoveContext** context, char* text,
                           size_t size);

#ifdef __cplusplus
}
#endif
