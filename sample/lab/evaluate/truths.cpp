#include "evaluate/truths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "support/progress.h"
#include "support/try.h"

namespace alcove::sample {
namespace {

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kTruthVersion = 1;
constexpr std::uint32_t kHeightFieldSlices = 24;

// Reads a truth from the cache, or computes it and writes it to the cache.
template <typename Truth, typename Compute>
tl::expected<Truth, std::string> cached(const TruthOptions& options, const Image<float>& depth,
                                        const CacheKey& key, const Compute& compute) {
  CacheKey bent_key = key;
  bent_key.add("bent");
  const TruthCache cache(options.use_cache ? TruthCache::default_folder()
                                           : std::filesystem::path());
  tl::expected<Truth, std::string> truth =
      Truth{{depth.width, depth.height}, {depth.width, depth.height}};
  if (cache.read(key, truth->visibility) && cache.read(bent_key, truth->bent_normal_ws)) {
    return truth;
  }
  truth = compute();
  if (truth) {
    cache.write(key, truth->visibility);
    cache.write(bent_key, truth->bent_normal_ws);
  }
  return truth;
}

tl::expected<OcclusionTruth, std::string> scene_truth(const TruthFrame& frame,
                                                      const TruthOptions& options,
                                                      const Image<float>& depth) {
  const TruthSettings settings{.radius = frame.radius, .spp = options.spp};
  CacheKey key;
  key.add("scene truth", kTruthVersion, frame.scene, frame.camera, settings.radius, settings.spp,
          depth, frame.normal_ws);
  return cached<OcclusionTruth>(options, depth, key, [&] {
    return RayScene::create(frame.scene).map([&](const RayScene& rays) {
      return occlusion_truth(rays, surface_points(rays, frame.camera, frame.normal_ws, depth),
                             settings, print_progress("scene truth"));
    });
  });
}

HeightFieldTruth depth_truth(const TruthFrame& frame, const TruthOptions& options,
                             const Image<float>& depth) {
  const HeightFieldSettings settings{frame.radius, kHeightFieldSlices};
  CacheKey key;
  key.add("height-field truth", kTruthVersion, frame.camera, settings.radius, settings.slices,
          depth, frame.normal_ws);
  const auto compute = [&] {
    return height_field_truth(depth, frame.normal_ws, frame.camera, settings,
                              print_progress("height-field truth"));
  };
  return cached<HeightFieldTruth>(options, depth, key, compute).value();  // it cannot fail
}

}  // namespace

tl::expected<Truths, std::string> truths_of(const TruthFrame& frame, const TruthOptions& options) {
  const Image<float> depth = linear_depth(frame.camera, frame.depth_ndc);
  Truths truths;
  truths.surfaces = Mask(depth.width, depth.height);
  for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
    truths.surfaces.pixels[i] = std::isfinite(depth.pixels[i]) ? 1 : 0;
  }
  if (std::ranges::find(truths.surfaces.pixels, 1) == truths.surfaces.pixels.end()) {
    return tl::unexpected<std::string>(
        "the view shows nothing but sky: turn it with --eye and --target, or widen --near and "
        "--far");
  }
  ALCOVE_TRY(auto scene, scene_truth(frame, options, depth));
  truths.scene = std::move(scene);
  truths.height_field = depth_truth(frame, options, depth);
  return truths;
}

}  // namespace alcove::sample
