#include "evaluate/truths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kTruthVersion = 2;
constexpr std::uint32_t kHeightFieldSlices = 24;

TruthCache cache_of(const TruthOptions& options) {
  return TruthCache(options.use_cache ? TruthCache::default_folder() : std::filesystem::path());
}

}  // namespace

Result<Truths> compute_truths(const TruthFrame& frame, const TruthOptions& options) {
  const Image<float> depth = linear_depth(frame.camera, frame.depth_ndc);
  const auto is_surface = [](float z) { return static_cast<std::uint8_t>(std::isfinite(z)); };
  Truths truths{{{depth.width, depth.height}, {depth.width, depth.height}},
                mapped(is_surface, depth)};
  if (std::ranges::find(truths.surfaces.pixels, 1) == truths.surfaces.pixels.end()) {
    return tl::unexpected<std::string>(
        "the view shows nothing but sky: turn it with --eye and --target, widen --near and --far, "
        "or draw back faces by --both-sides");
  }
  const TruthSettings settings{.radius = frame.radius, .spp = options.spp};
  CacheKey key;
  key.add("scene truth", kTruthVersion, frame.scene, frame.camera, settings.radius, settings.spp,
          depth, frame.normal_ws);
  const TruthCache cache = cache_of(options);
  if (cache.read(key, truths.scene.visibility, truths.scene.bent_normal_ws)) return truths;
  ALCOVE_TRY(const auto rays, RayScene::create(frame.scene));
  truths.scene = occlusion_truth(rays, surface_points(rays, frame.camera, frame.normal_ws, depth),
                                 settings, print_progress("scene truth"));
  cache.write(key, truths.scene.visibility, truths.scene.bent_normal_ws);
  return truths;
}

HeightFieldTruth compute_height_field_truth(const TruthFrame& frame, const TruthOptions& options) {
  const Image<float> depth = linear_depth(frame.camera, frame.depth_ndc);
  const HeightFieldSettings settings{frame.radius, kHeightFieldSlices};
  CacheKey key;
  key.add("height-field truth", kTruthVersion, frame.camera, settings.radius, settings.slices,
          depth, frame.normal_ws);
  const TruthCache cache = cache_of(options);
  HeightFieldTruth truth{{depth.width, depth.height}, {depth.width, depth.height}};
  if (!cache.read(key, truth.visibility, truth.bent_normal_ws)) {
    truth = height_field_truth(depth, frame.normal_ws, frame.camera, settings,
                               print_progress("height-field truth"));
    cache.write(key, truth.visibility, truth.bent_normal_ws);
  }
  return truth;
}

}  // namespace alcove::sample
