#include "evaluate/motion_renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <utility>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "support/try.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kMotionTruthVersion = 2;

}  // namespace

tl::expected<MotionRenderer, std::string> MotionRenderer::create(Gpu& gpu, const Scene& scene,
                                                                 const MotionPath& path,
                                                                 const MotionSetup& setup) {
  MotionRenderer made(path, setup);
  made.scene_ = std::make_unique<Scene>(scene);
  path.add_to(*made.scene_);
  ALCOVE_TRY(auto renderer,
             FrameRenderer::create(gpu, *made.scene_, {setup.width, setup.height}, setup.normals));
  made.renderer_ = std::move(renderer);
  return made;
}

FrameRequest MotionRenderer::request(const Step& step) const {
  const CameraMatrices now = camera_matrices(path_.camera(step.frame), setup_.width, setup_.height);
  const CameraMatrices before =
      camera_matrices(path_.camera(step.before), setup_.width, setup_.height);
  FrameRequest request;
  request.view = {now.view_from_world,
                  now.clip_from_view,
                  before.view_from_world,
                  before.clip_from_view,
                  path_.camera(step.frame).reversed_z,
                  path_.world_from_moving(step.frame),
                  path_.world_from_moving(step.before)};
  request.index = step.index;
  request.restart = step.restart;
  request.motion_vectors = step.moving;
  request.occlusion = setup_.occlusion;
  request.occlusion.specular = passes::Specular::none;
  request.occlusion.bent_normal = true;
  if (step.filtering != Filtering::spatial_and_temporal) request.occlusion.history_frames = 0;
  if (step.filtering == Filtering::none) request.occlusion.advanced.filter_radius = 0;
  return request;
}

tl::expected<RenderedFrame, std::string> MotionRenderer::draw_and_read(const Step& step) {
  ALCOVE_TRY(auto images, renderer_->draw_and_read(request(step)));
  const Camera camera = path_.camera(step.frame);
  return RenderedFrame{camera, linear_depth(camera, images.depth_ndc), std::move(images.normal_ws),
                       std::move(images.visibility), std::move(images.bent_normal_ws)};
}

tl::expected<void, std::string> MotionRenderer::draw(const Step& step) {
  return renderer_->draw(request(step)).map([](const FrameCost&) {});
}

Progress MotionRenderer::progress(const std::string& name) const {
  return setup_.progress ? setup_.progress(name) : Progress([](double) {});
}

tl::expected<MotionRenderer::Truth, std::string> MotionRenderer::truth(std::uint32_t frame,
                                                                       const RenderedFrame& seen) {
  path_.pose(*scene_, frame);
  const TruthCache cache(setup_.cache);
  const std::uint32_t half = std::max(setup_.spp / 2, 1u);
  const auto key_of = [&](std::uint32_t index, const char* image) {
    CacheKey key;
    key.add("motion truth", kMotionTruthVersion, *scene_, seen.camera, setup_.occlusion.radius,
            half, index, seen.depth, seen.normal_ws, image);
    return key;
  };
  struct Half {
    CacheKey visibility_key;
    CacheKey bent_normal_key;
    Image<float>& visibility;
    Image<glm::vec3>& bent_normal_ws;
  };
  const Image<float> no_visibility(setup_.width, setup_.height);
  const Image<glm::vec3> no_directions(setup_.width, setup_.height);
  Truth truth{{no_visibility, no_visibility}, {no_directions, no_directions}};
  const std::array halves{Half{key_of(0, "visibility"), key_of(0, "bent normal"),
                               truth.visibility.first, truth.bent_normal_ws.first},
                          Half{key_of(1, "visibility"), key_of(1, "bent normal"),
                               truth.visibility.second, truth.bent_normal_ws.second}};
  const bool known = std::ranges::all_of(halves, [&](const Half& known_half) {
    return cache.read(known_half.visibility_key, known_half.visibility) &&
           cache.read(known_half.bent_normal_key, known_half.bent_normal_ws);
  });
  if (known) return truth;
  ALCOVE_TRY(const auto rays, RayScene::create(*scene_));
  const SurfacePoints points = surface_points(rays, seen.camera, seen.normal_ws, seen.depth);
  const Progress whole = progress(fmt::format("truth of frame {}", frame));
  for (std::uint32_t i = 0; i < halves.size(); ++i) {
    const TruthSettings settings{.radius = setup_.occlusion.radius, .spp = half, .seed = 1 + i};
    OcclusionTruth traced =
        occlusion_truth(rays, points, settings, [&](double done) { whole(0.5 * (i + done)); });
    halves[i].visibility = std::move(traced.visibility);
    halves[i].bent_normal_ws = std::move(traced.bent_normal_ws);
    cache.write(halves[i].visibility_key, halves[i].visibility);
    cache.write(halves[i].bent_normal_key, halves[i].bent_normal_ws);
  }
  return truth;
}

}  // namespace alcove::sample
