// Loops and traffic of shaders/gtao.comp.
#include "pass_work.h"

namespace alcove::passes::cost {
namespace {

// Occluder runs whose ends a half-slice integrates: an assumption, since they depend on the scene.
// Taking 1 or 4 instead changes the totals by -3 % to +3 %.
constexpr double kOccluderRuns = 2.5;

}  // namespace

std::optional<double> gtao_iterations(const PassWork& work, const CompiledLoop& loop) {
  const OcclusionSettings& settings = work.settings;
  const bool sectors = has_thickness(settings.advanced.estimator);
  // Over the slices of a pixel, where there are several; within it over the two half-slices.
  if (settings.slices > 1 && loop.depth == 1) {
    return settings.slices;
  }
  if (loop.depth == (settings.slices > 1 ? 2 : 1)) {
    return 2;
  }
  if (loop.loads > 0) {
    // Over the steps of a half-slice. With sectors the first two are outside of the loop, and the
    // loop is unrolled four times.
    return sectors ? (settings.steps - 2) / 4 : settings.steps;
  }
  return kOccluderRuns;
}

double gtao_traffic(const PassWork& work, std::string_view image, Direction direction) {
  // One pixel in 4x4 reads its normal of 8 bytes: half of the cache lines of 64 bytes.
  const bool sparse = work.settings.tile_size == 4;
  return sparse && image == "normals" && direction == Direction::read ? 0.5 : 1.0;
}

}  // namespace alcove::passes::cost
