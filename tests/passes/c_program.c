#include "c_program.h"

#include <stdio.h>

AlcoveResult run_c_program(const AlcoveContextInfo* info, const AlcoveCamera* camera,
                           const AlcoveImage* depth, const AlcoveImage* visibility,
                           VkCommandBuffer commands, AlcoveContext** context, char* text,
                           size_t size) {
  char message[ALCOVE_MAX_MESSAGE];
  AlcoveSettings settings = {.struct_size = sizeof settings};
  AlcoveView view = {.struct_size = sizeof view};
  AlcoveFrame frame = {.struct_size = sizeof frame};
  AlcoveMemory memory = {.struct_size = sizeof memory};

  AlcoveResult result = alcoveCreateContext(info, context, message);
  if (result != ALCOVE_SUCCESS) {
    snprintf(text, size, "%s", message);
    return result;
  }
  result = alcoveGetSettings(ALCOVE_QUALITY_HIGH, 0.5f, &settings);
  if (result != ALCOVE_SUCCESS) return result;
  settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;

  view.info.settings = &settings;
  view.info.camera = *camera;
  view.info.previous_camera = *camera;
  view.images[ALCOVE_IMAGE_DEPTH] = *depth;
  view.images[ALCOVE_IMAGE_VISIBILITY] = *visibility;
  frame.view_count = 1;
  frame.views = &view;
  result = alcoveRecordFrame(*context, commands, &frame);
  if (result == ALCOVE_SUCCESS) result = alcoveGetMemory(*context, &memory);
  if (result != ALCOVE_SUCCESS) {
    snprintf(text, size, "%s", alcoveGetMessage(*context));
    return result;
  }
  snprintf(text, size, "%llu bytes of transients, %llu of history",
           (unsigned long long)memory.transients, (unsigned long long)memory.history);
  return ALCOVE_SUCCESS;
}
