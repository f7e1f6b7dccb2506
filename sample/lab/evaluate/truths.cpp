#include "evaluate/truths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kTruthVersion = 2;
constexpr std::uint32_t kHeightFieldSlices = 24;

Result<OcclusionTruth> scene_truth(const TruthFrame& frame, const TruthOptions& options,
                                   const TruthCache& cache, const Image<float>& depth) {
  const TruthSettings settings{.radius = frame.radius, .spp = options.spp};
  CacheKey key;
  key.add("scene truth", kTruthVersion, frame.scene, frame.camera, settings.radius, settings.spp,
          depth, frame.normal_ws);
  OcclusionTruth truth{{depth.width, depth.height}, {depth.width, depth.height}};
  if (cache.read_all(key, truth.visibility, truth.bent_normal_ws)) return truth;
  ALCOVE_TRY(const auto rays, RayScene::create(frame.scene));
  truth = occlusion_truth(rays, surface_points(rays, frame.camera, frame.normal_ws, depth),
                          settings, print_progress("scene truth"));
  cache.write_all(key, truth.visibility, truth.bent_normal_ws);
  return truth;
}

HeightFieldTruth depth_truth(const TruthFrame& frame, const TruthCache& cache,
                             const Image<float>& depth) {
  const HeightFieldSettings settings{frame.radius, kHeightFieldSlices};
  CacheKey key;
  key.add("height-field truth", kTruthVersion, frame.camera, settings.radius, settings.slices,
          depth, frame.normal_ws);
  HeightFieldTruth truth{{depth.width, depth.height}, {depth.width, depth.height}};
  if (!cache.read_all(key, truth.visibility, truth.bent_normal_ws)) {
    truth = height_field_truth(depth, frame.normal_ws, frame.camera, settings,
                               print_progress("height-field truth"));
    cache.write_all(key, truth.visibility, truth.bent_normal_ws);
  }
  return truth;
}

}  // namespace

Result<Truths> compute_truths(const TruthFrame& frame, const TruthOptions& options) {
  const Image<float> depth = linear_depth(frame.camera, frame.depth_ndc);
  Truths truths;
  truths.surfaces = Mask(depth.width, depth.height);
  for (std::size_t i = 0; i < depth.pixels.size(); ++i)
    truths.surfaces.pixels[i] = std::isfinite(depth.pixels[i]) ? 1 : 0;
  if (std::ranges::find(truths.surfaces.pixels, 1) == truths.surfaces.pixels.end()) {
    return tl::unexpected<std::string>(
        "the view shows nothing but sky: turn it with --eye and --target, widen --near and --far, "
        "or draw back faces by --both-sides");
  }
  const TruthCache cache(options.use_cache ? TruthCache::default_folder()
                                           : std::filesystem::path());
  ALCOVE_TRY(truths.scene, scene_truth(frame, options, cache, depth));
  truths.height_field = depth_truth(frame, cache, depth);
  return truths;
}

}  // namespace alcove::sample
