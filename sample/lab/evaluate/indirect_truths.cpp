#include "evaluate/indirect_truths.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kLightTruthVersion = 1;

std::uint32_t block_size(const Image<float>& depth, std::uint32_t points) {
  const double pixels = static_cast<double>(depth.pixels.size());
  return static_cast<std::uint32_t>(std::max(1.0, std::round(std::sqrt(pixels / points))));
}

// Chooses one pixel of each block, unless it shows the sky. The choice depends on the image size
// only.
Mask choose_pixels(const Image<float>& depth, std::uint32_t side) {
  Mask chosen(depth.width, depth.height);
  std::minstd_rand random;
  for (std::uint32_t y = 0; y < depth.height; y += side) {
    for (std::uint32_t x = 0; x < depth.width; x += side) {
      const auto column =
          std::min<std::uint32_t>(x + static_cast<std::uint32_t>(random() % side), depth.width - 1);
      const auto row = std::min<std::uint32_t>(y + static_cast<std::uint32_t>(random() % side),
                                               depth.height - 1);
      chosen.at(column, row) = std::isfinite(depth.at(column, row)) ? 1 : 0;
    }
  }
  return chosen;
}

class CachedTracer {
 public:
  CachedTracer(const Rendering& rendering, const TruthOptions& options, const RayScene& rays,
               const SurfacePoints& points)
      : rendering_(rendering),
        rays_(rays),
        points_(points),
        settings_{.radius = rendering.settings.radius, .spp = options.spp},
        cache_(options.use_cache ? TruthCache::default_folder() : std::filesystem::path()) {
    key_.add("light truth", kLightTruthVersion, rendering.scene, rendering.camera, settings_.radius,
             settings_.spp, points.position_ws, points.normal_ws);
  }

  Image<glm::vec3> interreflection() const {
    CacheKey key = key_;
    key.add("interreflection");
    return cached(key, [&] {
      return interreflection_truth(rays_, points_, settings_,
                                   print_progress("interreflection truth"));
    });
  }

  Image<float> specular(const Image<float>& roughness) const {
    CacheKey key = key_;
    key.add("specular", roughness);
    return cached(key, [&] {
      return specular_truth(rays_, points_, roughness, make_viewer(rendering_.camera), settings_,
                            print_progress("specular truth"));
    });
  }

  LitTruth lit(const Image<float>& roughness) const {
    const SurfaceMaterials materials{rendering_.images.albedo, roughness,
                                     rendering_.images.metallic};
    CacheKey key = key_;
    key.add("lit", materials.albedo, materials.roughness, materials.metallic,
            rendering_.light.environment);
    const std::uint32_t width = points_.normal_ws.width;
    const std::uint32_t height = points_.normal_ws.height;
    LitTruth truth{{width, height}, {width, height}, {width, height}, {width, height}};
    if (!cache_.read(key, truth.diffuse, truth.specular, truth.diffuse_noise,
                     truth.specular_noise)) {
      truth = lit_truth(rays_, points_, materials, make_viewer(rendering_.camera),
                        rendering_.light.environment, settings_, print_progress("lit truth"));
      cache_.write(key, truth.diffuse, truth.specular, truth.diffuse_noise, truth.specular_noise);
    }
    return truth;
  }

 private:
  template <class Compute>
  std::invoke_result_t<Compute> cached(const CacheKey& key, const Compute& compute) const {
    std::invoke_result_t<Compute> truth(points_.normal_ws.width, points_.normal_ws.height);
    if (cache_.read(key, truth)) return truth;
    truth = compute();
    cache_.write(key, truth);
    return truth;
  }

  const Rendering& rendering_;
  const RayScene& rays_;
  const SurfacePoints& points_;
  TruthSettings settings_;
  TruthCache cache_;
  CacheKey key_;
};

}  // namespace

std::vector<Image<float>> roughness_images(const Rendering& rendering) {
  const Image<float>& materials = rendering.images.roughness;
  if (rendering.light.roughness.empty()) return {materials};
  std::vector<Image<float>> images;
  for (const float roughness : rendering.light.roughness)
    images.emplace_back(materials.width, materials.height, roughness);
  return images;
}

Result<IndirectTruths> compute_indirect_truths(const Rendering& rendering,
                                               const TruthOptions& options) {
  ALCOVE_TRY(const auto rays, RayScene::create(rendering.scene));
  const Image<float> depth = linear_depth(rendering);
  IndirectTruths truths;
  truths.block = block_size(depth, options.indirect_points);
  truths.sampled = choose_pixels(depth, truths.block);
  truths.points = surface_points(rays, rendering.camera, rendering.images.normal_ws, depth);
  for (std::size_t i = 0; i < truths.sampled.pixels.size(); ++i)
    if (truths.sampled.pixels[i] == 0) truths.points.normal_ws.pixels[i] = glm::vec3(0.0f);
  const CachedTracer tracer(rendering, options, rays, truths.points);
  truths.interreflection = tracer.interreflection();
  for (const Image<float>& roughness : roughness_images(rendering))
    truths.specular.push_back(tracer.specular(roughness));
  if (rendering.light.lit_steps) truths.lit = tracer.lit(roughness_images(rendering).front());
  return truths;
}

}  // namespace alcove::sample
