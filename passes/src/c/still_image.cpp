// The frames of a still image.
#include "alcove/alcove.h"
#include "c/failure.h"
#include "c/settings.h"

using namespace alcove::passes;

uint32_t alcoveGetConvergedFrames(const AlcoveSettings* settings) {
  std::uint32_t frames = 0;
  guarded([&]() -> Result {
    return to_settings(settings).map(
        [&](const OcclusionSettings& known) { frames = converged_frames(known); });
  });
  return frames;
}

AlcoveResult alcoveSetStillFrame(uint32_t number, AlcoveView* view) {
  if (view == nullptr || view->struct_size != sizeof *view) return ALCOVE_ERROR_INVALID_INPUT;
  view->reset_history = number == 0 ? VK_TRUE : VK_FALSE;
  view->static_frames = number;
  view->previous_camera = view->camera;
  const bool whole = view->read_area.width == 0;
  view->previous_width = whole ? view->depth.width : view->read_area.width;
  view->previous_height = whole ? view->depth.height : view->read_area.height;
  return ALCOVE_SUCCESS;
}
