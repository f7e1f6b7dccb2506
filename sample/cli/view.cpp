#include <iostream>

#include "cli/commands.h"
#include "cli/scene_view_request.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {

Result<void> run_view(const Options& options) {
  if (!options.out.empty()) ALCOVE_TRY_VOID(create_folder(options.out));
  ALCOVE_TRY(auto view, SceneView::create(scene_view_request(options)));
  const std::uint32_t frames = options.view.frames;
  while (frames == 0 || view->drawn_frames() < frames) {
    if (view->drawn_frames() + 1 == frames && !options.out.empty()) view->take_screenshot();
    ALCOVE_TRY(const auto drawn, view->draw());
    if (!drawn) break;
  }
  return check_validation(view->gpu());
}

}  // namespace alcove::sample
