/* An engine in C: what it does once, and in each frame. Without a device main() only goes as far as
   the settings and the sentence that a context on no device gives. */
#include <alcove/alcove.h>
#include <stdio.h>
#include <string.h>

/* What the engine has already. */
typedef struct Engine {
  VkInstance instance;
  VkPhysicalDevice physical_device;
  VkDevice device;
  uint32_t queue_family;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  VkPhysicalDeviceFeatures2 features; /* that the device was made with, chained */
  VkPipelineCache pipeline_cache;     /* loaded when the engine starts, stored when it ends */
  AlcoveImage depth;                  /* attached while drawing, sampled afterwards */
  AlcoveImage occlusion;              /* R8_UNORM, sampled by the lighting */
  AlcoveCamera camera, previous_camera;
  uint32_t frame; /* counts */
} Engine;

static AlcoveResult start(const Engine* engine, AlcoveContext** context, char* message) {
  AlcoveContextInfo info = {.struct_size = sizeof info};
  info.queue_family = engine->queue_family;
  info.instance = engine->instance;
  info.physical_device = engine->physical_device;
  info.device = engine->device;
  info.get_instance_proc_addr = engine->get_instance_proc_addr;
  info.enabled_features = &engine->features;
  info.frames_in_flight = 2;
  info.timestamps = VK_TRUE;
  info.pipeline_cache = engine->pipeline_cache;
  return alcoveCreateContext(&info, context, message);
}

static AlcoveView view_of(const Engine* engine, const AlcoveSettings* settings) {
  AlcoveView view = {.struct_size = sizeof view};
  view.info.settings = settings;
  view.info.camera = engine->camera;
  view.info.previous_camera = engine->previous_camera;
  AlcoveImage* depth = &view.images[ALCOVE_IMAGE_DEPTH];
  AlcoveImage* visibility = &view.images[ALCOVE_IMAGE_VISIBILITY];
  *depth = engine->depth;
  depth->initial_state.stages = VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  depth->initial_state.access = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  depth->initial_state.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  depth->final_state.stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  depth->final_state.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  depth->final_state.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  *visibility = engine->occlusion;
  /* The lighting of the frame before read it; what it holds is not needed any more. */
  visibility->initial_state.stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  visibility->initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  visibility->final_state.stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  visibility->final_state.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  visibility->final_state.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  return view;
}

/* While loading, and before the settings change: so that no frame waits for a pipeline. */
static AlcoveResult prepare_occlusion(AlcoveContext* context, const Engine* engine,
                                      const AlcoveSettings* settings) {
  const AlcoveView view = view_of(engine, settings);
  const AlcoveFrame frame = {.struct_size = sizeof frame, .view_count = 1, .views = &view};
  return alcovePrepareFrame(context, &frame);
}

/* Between drawing and lighting, outside a render pass; the slot's fence has been waited for. */
static AlcoveResult record_occlusion(AlcoveContext* context, const Engine* engine,
                                     const AlcoveSettings* settings, VkCommandBuffer commands) {
  const AlcoveView view = view_of(engine, settings);
  AlcoveFrame frame = {.struct_size = sizeof frame, .view_count = 1, .views = &view};
  frame.index = engine->frame;
  frame.slot = engine->frame % 2;
  return alcoveRecordFrame(context, commands, &frame);
}

int main(void) {
  Engine engine;
  AlcoveContext* context = NULL;
  AlcoveSettings settings = {.struct_size = sizeof settings};
  char message[ALCOVE_MAX_MESSAGE];
  char text[1024];
  AlcoveResult result;

  memset(&engine, 0, sizeof engine);
  if (alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings) != ALCOVE_SUCCESS) return 1;
  settings.history_frames = 16;
  if (alcovePrintSettings(&settings, text, sizeof text) >= sizeof text) return 1;
  printf("Alcove %u.%u.%u\n%s", VK_API_VERSION_MAJOR(alcoveGetVersion()),
         VK_API_VERSION_MINOR(alcoveGetVersion()), VK_API_VERSION_PATCH(alcoveGetVersion()), text);

  result = start(&engine, &context, message);
  printf("%s: %s\n", alcoveGetResultName(result), message);
  if (result != ALCOVE_ERROR_INVALID_INPUT || message[0] == '\0') return 1;
  if (prepare_occlusion(context, &engine, &settings) != ALCOVE_ERROR_INVALID_INPUT) return 1;
  result = record_occlusion(context, &engine, &settings, VK_NULL_HANDLE);
  alcoveDestroyContext(context);
  return result == ALCOVE_ERROR_INVALID_INPUT ? 0 : 1;
}
