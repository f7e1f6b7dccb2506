// Loops and traffic of shaders/gtao.comp.
#include "pass_work.h"

namespace alcove::passes::cost {
namespace {

// Ends of occluder runs in a half-slice, at which a GGX lobe is integrated: an assumption, since
// they depend on the scene.
constexpr double kOccluderRuns = 2.5;

}  // namespace

std::optional<double> gtao_iterations(const PassWork& work, const CompiledLoop& loop) {
  const OcclusionSettings& settings = work.settings;
  const bool connected = settings.advanced.estimator == Estimator::connected;
  // Over the slices of a pixel, where there are several; within it over the two half-slices.
  if (settings.slices > 1 && loop.depth == 1) {
    return settings.slices;
  }
  if (loop.depth == (settings.slices > 1 ? 2 : 1)) {
    return 2;
  }
  if (loop.loads > 0) {
    // Over the steps of a half-slice. With connected samples the first two are outside of the loop,
    // and an iteration of the loop has kUnrolled of shaders/gtao_connected.h.
    const std::uint32_t unrolled = settings.slices > 1 ? 2 : 4;
    return connected ? (settings.steps - 2) / unrolled : settings.steps;
  }
  return kOccluderRuns;
}

double gtao_traffic(const PassWork& work, std::string_view image, Direction direction) {
  // The share of the cache lines of 64 bytes, eight normals, that hold a traced pixel: of every
  // `tile` rows one, and of its lines all if there are eight traced pixels or fewer between them.
  const std::uint32_t tile = work.settings.tile_size;
  const bool normals = image == "normals" && direction == Direction::read;
  return normals && tile >= 4 ? 1.0 / tile : 1.0;
}

}  // namespace alcove::passes::cost
