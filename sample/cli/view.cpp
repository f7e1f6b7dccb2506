#include <iostream>

#include "cli/commands.h"
#include "cli/scene_view_request.h"

namespace alcove::sample {

tl::expected<void, std::string> run_view(const Options& options) {
  auto view = SceneView::create(scene_view_request(options));
  if (!view) {
    return tl::unexpected(std::move(view.error()));
  }
  const std::uint32_t frames = options.view.frames;
  while (frames == 0 || (*view)->drawn_frames() < frames) {
    if ((*view)->drawn_frames() + 1 == frames && !options.out.empty()) {
      (*view)->take_screenshot();
    }
    const auto drawn = (*view)->draw();
    if (!drawn) {
      return tl::unexpected(drawn.error());
    }
    if (!*drawn) {
      break;
    }
  }
  return check_validation((*view)->gpu());
}

}  // namespace alcove::sample
