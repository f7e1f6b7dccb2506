// Loops and traffic of shaders/reconstruct.comp.
#include "pass_work.h"

namespace alcove::passes::cost {

std::optional<double> reconstruct_iterations(const PassWork& work, const CompiledLoop& loop) {
  // The only loops are those of add_ring(): over rows of traced pixels and, within a row, over the
  // pixels. Pixels with a history run them only while it is less than two frames old, which is
  // rare.
  if (work.settings.history_frames > 0 && work.state != FrameState::first) {
    return 0.0;
  }
  const double radius = work.settings.advanced.filter_radius;
  const double across = work.settings.tile_size > 1 ? 2 * radius : 2 * radius + 1;
  const double corners = radius > 1 ? 4 : 0;
  return loop.depth == 1 ? across : (across * across - corners) / across;
}

double reconstruct_traffic(const PassWork& work, std::string_view image, Direction direction) {
  // The name of every history begins with the view's; a first frame reads none.
  const bool history = image.starts_with("occlusion");
  return history && direction == Direction::read && work.state == FrameState::first ? 0.0 : 1.0;
}

}  // namespace alcove::passes::cost
