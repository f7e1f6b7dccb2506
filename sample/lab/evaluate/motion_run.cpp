#include "evaluate/motion_run.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "reference/surface_points.h"
#include "reference/truth_cache.h"
#include "render/frame_renderer.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

// Increment when the computation of a truth changes, so that old cache entries are not used.
constexpr std::uint32_t kMotionTruthVersion = 3;

constexpr std::uint32_t kCompared = 3;  // frames of a path

// How raw occlusion is filtered: over neighbouring pixels, or also over frames.
enum class Filtering : std::uint8_t { spatial, spatial_and_temporal };

// The parameters of one rendered frame.
struct Step {
  std::uint32_t frame = 0;   // frame of the path whose camera and object positions are used
  std::uint32_t before = 0;  // frame of the path that was rendered last; motion is relative to it
  std::uint32_t index = 0;   // frame index that selects the sampling pattern
  bool restart = false;      // whether the history is discarded
  Filtering filtering = Filtering::spatial_and_temporal;
  bool moving = true;  // whether the pass is given motion vectors
};

// The truth at the surfaces that a frame shows, in two independent halves.
struct MotionTruth {
  SplitTruth<float> visibility;
  SplitTruth<glm::vec3> bent_normal_ws;
};

// Renders the frames of one path and traces their truths.
class MotionRenderer {
 public:
  static Result<MotionRenderer> create(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                       const MotionSetup& setup) {
    MotionRenderer renderer(path, setup);
    renderer.scene_ = std::make_unique<Scene>(scene);
    path.add_to(*renderer.scene_);
    ALCOVE_TRY(renderer.renderer_,
               FrameRenderer::create(gpu, *renderer.scene_, {setup.view.width, setup.view.height},
                                     setup.view.normals));
    return renderer;
  }

  Result<RenderedFrame> draw_and_read(const Step& step) {
    ALCOVE_TRY(auto images, renderer_->draw_and_read(request(step)));
    const Camera camera = path_.camera(step.frame);
    return RenderedFrame{camera, linear_depth(camera, images.depth_ndc),
                         std::move(images.normal_ws), std::move(images.visibility),
                         std::move(images.bent_normal_ws)};
  }
  Result<void> draw(const Step& step) {
    return renderer_->draw(request(step)).map([](const FrameCost&) {});
  }

  Result<MotionTruth> truth(std::uint32_t frame, const RenderedFrame& seen);

  const MotionPath& path() const { return path_; }

 private:
  MotionRenderer(const MotionPath& path, const MotionSetup& setup) : path_(path), setup_(setup) {}

  FrameRequest request(const Step& step) const {
    const auto matrices = [&](std::uint32_t frame) {
      return camera_matrices(path_.camera(frame), setup_.view.width, setup_.view.height);
    };
    const CameraMatrices now = matrices(step.frame);
    const CameraMatrices before = matrices(step.before);
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
    request.occlusion.specular = ALCOVE_SPECULAR_NONE;
    request.occlusion.bent_normal = true;
    if (step.filtering != Filtering::spatial_and_temporal) request.occlusion.history_frames = 0;
    return request;
  }

  MotionPath path_;
  MotionSetup setup_;
  std::unique_ptr<Scene> scene_;  // at a fixed address, which renderer_ keeps
  std::unique_ptr<FrameRenderer> renderer_;
};

Result<MotionTruth> MotionRenderer::truth(std::uint32_t frame, const RenderedFrame& seen) {
  path_.pose(*scene_, frame);
  const TruthCache cache(setup_.truth.use_cache ? TruthCache::default_folder()
                                                : std::filesystem::path());
  const std::uint32_t half = std::max(setup_.truth.spp / 2, 1u);
  CacheKey key;
  key.add("motion truth", kMotionTruthVersion, *scene_, seen.camera, setup_.occlusion.radius, half,
          seen.depth, seen.normal_ws);
  const Image<float> no_visibility(setup_.view.width, setup_.view.height);
  const Image<glm::vec3> no_directions(setup_.view.width, setup_.view.height);
  MotionTruth truth{{no_visibility, no_visibility}, {no_directions, no_directions}};
  auto& [visibility, bent_normal_ws] = truth;
  if (cache.read_all(key, visibility.first, visibility.second, bent_normal_ws.first,
                     bent_normal_ws.second))
    return truth;
  ALCOVE_TRY(const auto rays, RayScene::create(*scene_));
  const SurfacePoints points = surface_points(rays, seen.camera, seen.normal_ws, seen.depth);
  const Progress whole = print_progress(fmt::format("truth of frame {}", frame));
  const auto trace = [&](std::uint32_t index) {
    const TruthSettings settings{.radius = setup_.occlusion.radius, .spp = half, .seed = 1 + index};
    return occlusion_truth(rays, points, settings,
                           [&](double done) { whole(0.5 * (index + done)); });
  };
  OcclusionTruth first = trace(0);
  OcclusionTruth second = trace(1);
  truth = {{std::move(first.visibility), std::move(second.visibility)},
           {std::move(first.bent_normal_ws), std::move(second.bent_normal_ws)}};
  cache.write_all(key, visibility.first, visibility.second, bent_normal_ws.first,
                  bent_normal_ws.second);
  return truth;
}

Mask surface_mask(const RenderedFrame& seen) {
  return surfaces_where(seen, [](const glm::vec3&) { return true; });
}

Mask pixels_with_age(const Image<Age>& ages, bool uncovered) {
  Mask mask(ages.width, ages.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    const Age& age = ages.pixels[i];
    mask.pixels[i] = age.frames == kUncoveredFrames && age.uncovered == uncovered ? 1 : 0;
  }
  return mask;
}

// A rendered frame that will be compared with the truth.
struct ComparedFrame {
  std::uint32_t frame = 0;
  RenderedFrame seen;
  Image<Age> ages;
  RenderedFrame before;
  Reprojection reprojection;
};

// Sums over the frames of a path.
struct PathResult {
  RunningMean change;
  RunningMean speed;
  RunningMean fast;
  std::vector<ComparedFrame> compared;
};

std::uint32_t first_converged(const MotionPath& path) { return path.frames() / kCompared; }

bool is_compared(const MotionPath& path, std::uint32_t frame) {
  for (std::uint32_t i = 1; i <= kCompared; ++i)
    if (frame + 1 == i * path.frames() / kCompared) return true;
  return false;
}

Result<PathResult> render_path(MotionRenderer& renderer, Filtering filtering) {
  const bool history = filtering == Filtering::spatial_and_temporal;
  PathResult path_result;
  const MotionPath& path = renderer.path();
  const Progress progress =
      print_progress(std::string(name_of(path.kind())) + (history ? "" : " without history"));
  // Frames before the first measured one are rendered only if there is a history to fill.
  const std::uint32_t first = history ? 0 : first_converged(path) - 1;
  RenderedFrame before;
  Image<Age> ages;
  for (std::uint32_t frame = first; frame < path.frames(); ++frame) {
    ALCOVE_TRY(auto seen, renderer.draw_and_read({.frame = frame,
                                                  .before = frame - (frame > first ? 1 : 0),
                                                  .index = frame,
                                                  .filtering = filtering}));
    if (frame == first) {
      ages = first_ages(seen);
    } else {
      const Reprojection reprojection = reproject(seen, before, [&](const glm::vec3& position) {
        return path.position_before(position, frame);
      });
      ages = next_ages(seen, reprojection, ages);
      if (frame >= first_converged(path))
        path_result.change += visibility_change(seen.visibility, before.visibility, reprojection);
      const Speed speed = measure_speed(reprojection);
      path_result.speed += {speed.mean, 1};
      path_result.fast += {speed.percentile_95, 1};
      if (history && is_compared(path, frame))
        path_result.compared.push_back({frame, seen, ages, std::move(before), reprojection});
    }
    before = std::move(seen);
    progress(static_cast<double>(frame + 1 - first) / (path.frames() - first));
  }
  return path_result;
}

// The last of a number of frames without motion, and its change since the frame before.
struct StaticResult {
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;
  RunningMean change;
};

Result<StaticResult> render_static(MotionRenderer& renderer, std::uint32_t frame) {
  for (std::uint32_t index = 0; index + 1 < frame; ++index) {
    ALCOVE_TRY_VOID(
        renderer.draw({.frame = frame, .before = frame, .index = index, .moving = false}));
  }
  const auto read = [&](std::uint32_t index) {
    return renderer.draw_and_read(
        {.frame = frame, .before = frame, .index = index, .moving = false});
  };
  ALCOVE_TRY(const auto before, read(frame - 1));
  ALCOVE_TRY(auto last, read(frame));
  StaticResult still;
  for (std::size_t i = 0; i < last.depth.pixels.size(); ++i)
    if (std::isfinite(last.depth.pixels[i]))
      still.change += {std::abs(last.visibility.pixels[i] - before.visibility.pixels[i]), 1};
  still.visibility = std::move(last.visibility);
  still.bent_normal_ws = std::move(last.bent_normal_ws);
  return still;
}

// Squared errors with and without motion over the same pixels.
struct SquaresPair {
  RunningMean moving;
  RunningMean static_camera;

  template <class T>
  void add(const Image<T>& moved, const Image<T>& fixed, const SplitTruth<T>& truth,
           const Mask& mask) {
    moving += squared_error(moved, truth, mask);
    static_camera += squared_error(fixed, truth, mask);
  }
  ErrorPair errors() const { return {moving.count, root(moving), root(static_camera)}; }
};

// Sums over the compared frames. Those of bent normals are in radians.
struct Comparison {
  std::array<SquaresPair, kMotionErrorNames.size()> errors;
  RunningMean static_change;
  RunningMean truth_change;

  SquaresPair& operator[](MotionError kind) { return errors[static_cast<std::size_t>(kind)]; }
};

// Adds a compared frame to the sums and to `report`.
Result<void> compare(MotionRenderer& renderer, const ComparedFrame& compared, Comparison& sums,
                     MotionReport& report) {
  ALCOVE_TRY(auto still, render_static(renderer, compared.frame));
  ALCOVE_TRY(const auto truth, renderer.truth(compared.frame, compared.seen));
  ALCOVE_TRY(const auto truth_before, renderer.truth(compared.frame - 1, compared.before));
  const auto is_near_object = [&](const glm::vec3& position) {
    return renderer.path().is_near_object(position, compared.frame, kTrailFrames);
  };
  const RenderedFrame& seen = compared.seen;
  const Mask surfaces = surface_mask(seen);
  const auto add = [&](MotionError kind, const Mask& mask) {
    sums[kind].add(seen.visibility, still.visibility, truth.visibility, mask);
  };
  add(MotionError::all, surfaces);
  add(MotionError::uncovered, pixels_with_age(compared.ages, true));
  add(MotionError::entered, pixels_with_age(compared.ages, false));
  add(MotionError::near_object, surfaces_where(seen, is_near_object));
  sums[MotionError::bent_normals].add(seen.bent_normal_ws, still.bent_normal_ws,
                                      truth.bent_normal_ws, surfaces);
  sums.static_change += still.change;
  sums.truth_change +=
      change_lower_bound(truth.visibility, truth_before.visibility, compared.reprojection);
  Image<float> mean_truth = mean_image(truth.visibility);
  report.weave += measure_weave(seen.visibility, mean_truth, surfaces);
  report.static_weave += measure_weave(still.visibility, mean_truth, surfaces);
  report.pictures.push_back(
      {compared.frame, seen.visibility, std::move(still.visibility), std::move(mean_truth)});
  return {};
}

// The frames 1, 2, 4, ... after the cut; with `restart` the history is discarded at the cut.
Result<std::vector<RenderedFrame>> after_cut(MotionRenderer& renderer, bool restart) {
  const MotionPath& path = renderer.path();
  const std::uint32_t cut = path.cut().value_or(0);
  std::vector<RenderedFrame> seen;
  for (std::uint32_t frame = restart ? cut : 0; frame < path.frames(); ++frame) {
    const std::uint32_t since = frame + 1 - std::min(cut, frame + 1);
    const Step step{.frame = frame,
                    .before = frame == 0 || (restart && frame == cut) ? frame : frame - 1,
                    .index = frame,
                    .restart = restart && frame == cut};
    // 1, 2, 4, ...
    if (since > 0 && (since & (since - 1)) == 0) {
      ALCOVE_TRY(auto images, renderer.draw_and_read(step));
      seen.push_back(std::move(images));
    } else {
      ALCOVE_TRY_VOID(renderer.draw(step));
    }
  }
  return seen;
}

Result<MotionReport> run_cut(MotionRenderer& renderer) {
  ALCOVE_TRY(auto kept_frames, after_cut(renderer, false));
  ALCOVE_TRY(auto restarted_frames, after_cut(renderer, true));
  const std::uint32_t cut = renderer.path().cut().value_or(0);
  ALCOVE_TRY(const auto truth, renderer.truth(cut, kept_frames.front()));
  MotionReport report;
  const Mask surfaces = surface_mask(kept_frames.front());
  for (std::size_t i = 0; i < kept_frames.size(); ++i) {
    RenderedFrame& kept = kept_frames[i];
    RenderedFrame& restarted = restarted_frames[i];
    const std::uint32_t frames = 1u << i;
    const SplitTruth<float>& visibility = truth.visibility;
    report.after_cut.push_back({frames, root(squared_error(kept.visibility, visibility, surfaces)),
                                root(squared_error(restarted.visibility, visibility, surfaces))});
    report.pictures.push_back({cut + frames - 1, std::move(kept.visibility),
                               std::move(restarted.visibility), mean_image(visibility)});
  }
  return report;
}

}  // namespace

Result<MotionReport> run_motion(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                const MotionSetup& setup) {
  ALCOVE_TRY(auto renderer, MotionRenderer::create(gpu, scene, path, setup));
  if (path.cut()) return run_cut(renderer);
  ALCOVE_TRY(const auto path_result, render_path(renderer, Filtering::spatial_and_temporal));
  ALCOVE_TRY(const auto without_history, render_path(renderer, Filtering::spatial));
  MotionReport report{.speed = {path_result.speed.mean(), path_result.fast.mean()}};
  Comparison sums;
  for (const ComparedFrame& compared : path_result.compared)
    ALCOVE_TRY_VOID(compare(renderer, compared, sums, report));
  std::ranges::transform(sums.errors, report.errors.begin(), &SquaresPair::errors);
  ErrorPair& angles = report.errors.back();
  angles.moving = glm::degrees(angles.moving);
  angles.static_camera = glm::degrees(angles.static_camera);
  report.flicker = {path_result.change.mean(), without_history.change.mean(),
                    sums.static_change.mean(), sums.truth_change.mean()};
  return report;
}

}  // namespace alcove::sample
