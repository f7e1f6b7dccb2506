// Loops and traffic of shaders/reconstruct.comp.
#include <algorithm>

#include "pass_work.h"

namespace alcove::passes::cost {

namespace {

// The share of the 64-byte blocks of normals that contain a pixel whose tangent plane needs the
// normal. It was measured in the atrium, the arcade and the helmet, where 5 to 8 % of the pixels
// do.
constexpr double kNormalShare = 0.2;

// Whether the tangent plane of most pixels comes from depth alone.
bool has_depth_planes(const PassWork& work) {
  return !work.settings.half_resolution && work.settings.history_frames > 0 &&
         work.state != FrameState::first && work.settings.specular != Specular::slices;
}

}  // namespace

std::optional<double> reconstruct_iterations(const PassWork& work, const CompiledLoop& loop) {
  const bool column = work.settings.tile_size > (work.settings.half_resolution ? 2u : 1u);
  // The outermost loop runs over the blocks of a column. The loops of sum_wide() are counted as not
  // run: pixels with a history run them only while it is less than two frames old, which is rare.
  return column && loop.depth == 1 ? 4.0 : 0.0;
}

double reconstruct_traffic(const PassWork& work, std::string_view image, Direction direction) {
  if (image == "normals" && !work.settings.bent_normal && has_depth_planes(work)) {
    return kNormalShare;
  }
  // The name of every history begins with the view's; a first frame reads none.
  const bool history = image.starts_with("occlusion");
  return history && direction == Direction::read && work.state == FrameState::first ? 0.0 : 1.0;
}

std::vector<LoadPattern> reconstruct_loads(const PassWork& work) {
  const OcclusionSettings& settings = work.settings;
  const bool half = settings.half_resolution;
  std::vector<LoadPattern> loads;
  // load_tiles(): the raw occlusion of adjacent tiles, in up to four instructions.
  const std::uint32_t span =
      (half ? 16u : 8u) / settings.tile_size +
      2 * std::min(settings.advanced.filter_radius, work.state == FrameState::first ? 3u : 1u);
  const std::uint32_t across = (span + 7) / 8;
  loads.push_back({.texel_bytes = 8, .anywhere = true, .count = across * across});
  if (half) {
    // The four gathers of representative(), two of which begin a pixel before the texels.
    loads.push_back({.pitch = 2, .footprint = 2, .first = -1, .count = 2});
    loads.push_back({.pitch = 2, .footprint = 2, .first = 1, .count = 2});
  } else {
    // The two gathers of the depths, the first of which begins a pixel before the pixels.
    loads.push_back({.footprint = 2, .first = -1});
    loads.push_back({.footprint = 2});
    if (!has_depth_planes(work)) {
      loads.push_back({.texel_bytes = 8});  // normal
    }
  }
  if (settings.history_frames == 0 || work.state == FrameState::first) {
    return loads;
  }
  const bool moving = work.state == FrameState::moving;
  const std::uint32_t footprint = moving ? 2 : 1;
  const std::uint32_t channels = moving ? 2 : 1;  // a gather reads one
  if (half) {
    loads.push_back({.footprint = footprint, .anywhere = moving});  // depth
    loads.push_back(
        {.texel_bytes = 8, .footprint = footprint, .anywhere = moving, .count = channels});
  } else {
    loads.push_back({.footprint = footprint, .anywhere = moving, .count = channels});
  }
  return loads;
}

}  // namespace alcove::passes::cost
