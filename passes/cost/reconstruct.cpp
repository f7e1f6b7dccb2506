// Loops and traffic of shaders/reconstruct.comp.
#include <algorithm>

#include "pass_work.h"

namespace alcove::passes::cost {
namespace {

// Pixels of an interpolation cell that this frame's traced pixels tell something new of, once the
// image has converged; kReached of the shader has a bit for each.
double reached_pixels(std::uint32_t tile_size) { return tile_size == 4 ? 5 : 1; }

double cell_pixels(std::uint32_t tile_size) { return tile_size * tile_size; }

}  // namespace

std::optional<double> reconstruct_iterations(const PassWork& work, const CompiledLoop& loop) {
  const std::uint32_t tile_size = work.settings.tile_size;
  // The wider filter of a pixel whose history is one frame old: rare.
  if (loop.depth > 1) {
    return 0.0;
  }
  if (work.state != FrameState::converged) {
    return cell_pixels(tile_size);
  }
  // First over the pixels that are reached, then over the rest. Where one pixel is reached the
  // compiler removes the first loop.
  const auto outermost = std::ranges::count(work.loops, 1u, &CompiledLoop::depth);
  const bool over_rest = outermost == 1 || loop.index > 0;
  return over_rest ? cell_pixels(tile_size) - reached_pixels(tile_size) : reached_pixels(tile_size);
}

double reconstruct_traffic(const PassWork& work, std::string_view image, Direction direction) {
  const bool history = image.starts_with("occlusion") && image != "occlusion signal";
  if (!history) {
    return 1.0;
  }
  if (direction == Direction::read) {
    return work.state == FrameState::first ? 0.0 : 1.0;
  }
  // A converged image stores only the pixels that are reached.
  return work.state == FrameState::converged
             ? reached_pixels(work.settings.tile_size) / cell_pixels(work.settings.tile_size)
             : 1.0;
}

}  // namespace alcove::passes::cost
