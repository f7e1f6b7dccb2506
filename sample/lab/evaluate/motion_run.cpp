#include "evaluate/motion_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "render/frame_renderer.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kCompared = 3;  // frames of a path

// The number of frames after which surfaces that came into view are measured. Their errors should
// then be nearly as small as those of other surfaces.
constexpr std::uint32_t kNewFrames = 4;  // as in kMotionErrorTitles

// Surfaces that a moving object passed within this many last frames are measured separately,
// because a history could leave a trail of the object there for that long.
constexpr std::uint32_t kTrailFrames = 32;

// A frame of the path.
struct PathFrame {
  std::uint32_t frame = 0;
  FrameImages images;
  Mask uncovered;  // surfaces that came into view kNewFrames ago
};

// Root mean squares over several images.
struct Squares {
  double sum = 0;
  std::uint64_t count = 0;

  void add(const ErrorSummary& error) {
    sum += error.rmse * error.rmse * static_cast<double>(error.count);
    count += error.count;
  }
  double root() const { return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0; }
};

// Renders one path. Views without motion are those of a scene with the object at its place.
class MotionRun {
 public:
  MotionRun(Gpu& gpu, const Scene& scene, const MotionPath& path, const MotionSetup& setup)
      : gpu_(gpu), scene_(scene), path_(path), setup_(setup) {
    path_.add_to(scene_);
    setup_.view.orbit = 0;
    setup_.occlusion.bent_normal = true;
  }

  Result<MotionReport> run() {
    if (path_.cut()) return run_cut();
    MotionReport report;
    std::vector<RenderedFrame> seen(path_.frames());
    std::vector<PathFrame> compared;
    RunningMean speed, change, unfiltered;
    ALCOVE_TRY(const auto renderer, create_renderer());
    const Progress progress = print_progress(std::string(name_of(path_.kind())));
    for (std::uint32_t frame = 0; frame < path_.frames(); ++frame) {
      progress(static_cast<double>(frame) / path_.frames());
      if (!is_compared(frame, kNewFrames)) {
        ALCOVE_TRY_VOID(renderer->draw(request(setup_.occlusion, frame)));
        continue;
      }
      ALCOVE_TRY(auto images, renderer->draw_and_read(request(setup_.occlusion, frame)));
      seen[frame] = rendered(frame, images);
      if (!is_compared(frame)) continue;
      const Reprojection last = reprojection(seen, frame, 1);
      speed += measure_speed(last);
      change += visibility_change(seen[frame].visibility, seen[frame - 1].visibility, last);
      // In view in each of the last kNewFrames frames, and not in the frame before them.
      Mask uncovered = surfaces_where(seen[frame], [](const glm::vec3&) { return true; });
      for (std::uint32_t ago = 1; ago <= kNewFrames; ++ago) {
        const Reprojection then = reprojection(seen, frame, ago);
        for (std::size_t i = 0; i < uncovered.pixels.size(); ++i)
          if ((then.texels.pixels[i] != 0) != (ago < kNewFrames)) uncovered.pixels[i] = 0;
      }
      compared.push_back({frame, std::move(images), std::move(uncovered)});
    }
    progress(1.0);
    OcclusionSettings no_history = setup_.occlusion;
    no_history.history_frames = 0;
    for (const PathFrame& now : compared) {
      ALCOVE_TRY_VOID(compare(now, seen[now.frame], report));
      ALCOVE_TRY(const auto before, renderer->draw_and_read(request(no_history, now.frame - 1)));
      ALCOVE_TRY(const auto after, renderer->draw_and_read(request(no_history, now.frame)));
      unfiltered +=
          visibility_change(after.visibility, before.visibility, reprojection(seen, now.frame, 1));
    }
    report.speed = speed.mean();
    report.flicker = {change.mean(), unfiltered.mean()};
    for (std::size_t i = 0; i < report.errors.size(); ++i)
      report.errors[i] = {moving_[i].count, moving_[i].root(), static_[i].root()};
    return report;
  }

 private:
  // Whether this frame, or one of the `later` frames after it, is compared with the truth.
  bool is_compared(std::uint32_t frame, std::uint32_t later = 0) const {
    for (std::uint32_t i = 1; i <= kCompared; ++i) {
      const std::uint32_t end = i * path_.frames() / kCompared;
      if (frame < end && frame + 1 + later >= end) return true;
    }
    return false;
  }

  Result<std::unique_ptr<FrameRenderer>> create_renderer() {
    return FrameRenderer::create(gpu_, scene_, setup_.view);
  }

  FrameRequest request(const OcclusionSettings& settings, std::uint32_t frame) const {
    StaticSetup view = setup_.view;
    view.camera = path_.camera(frame);
    FrameRequest request = frame_request(view, settings, frame);
    const std::uint32_t before = std::max(frame, 1u) - 1;
    request.view = gbuffer_view(view.camera, path_.camera(before), {view.width, view.height});
    request.view.world_from_moving = path_.world_from_moving(frame);
    request.view.previous_world_from_moving = path_.world_from_moving(before);
    request.static_frames = 0;
    request.motion_vectors = true;
    return request;
  }

  RenderedFrame rendered(std::uint32_t frame, const FrameImages& images) const {
    const Camera camera = path_.camera(frame);
    return {camera, linear_depth(camera, images.depth_ndc), images.normal_ws, images.visibility};
  }

  // Where the surfaces of a frame were on the image `ago` frames earlier.
  Reprojection reprojection(const std::vector<RenderedFrame>& seen, std::uint32_t frame,
                            std::uint32_t ago) const {
    return reproject(seen[frame], seen[frame - ago], [&](glm::vec3 position) {
      for (std::uint32_t i = 0; i < ago; ++i) position = path_.position_before(position, frame - i);
      return position;
    });
  }

  // Draws a number of frames of the view of `frame` without motion.
  Result<FrameImages> draw_without_motion(std::uint32_t frame, std::uint32_t frames) {
    path_.pose(scene_, frame);
    StaticSetup view = setup_.view;
    view.camera = path_.camera(frame);
    view.frames = frames;
    return draw_static(gpu_, scene_, view, setup_.occlusion);
  }

  Result<Truths> truth(std::uint32_t frame, const FrameImages& images) {
    path_.pose(scene_, frame);
    return compute_truths(
        {scene_, path_.camera(frame), setup_.occlusion.radius, images.depth_ndc, images.normal_ws},
        setup_.truth);
  }

  // Adds a compared frame to the sums and to `report`.
  Result<void> compare(const PathFrame& compared, const RenderedFrame& seen, MotionReport& report) {
    ALCOVE_TRY(auto still, draw_without_motion(compared.frame, compared.frame + 1));
    ALCOVE_TRY(auto truths, truth(compared.frame, compared.images));
    const Image<float>& true_visibility = truths.scene.visibility;
    const auto add = [&](MotionError kind, const Mask& mask) {
      const auto i = static_cast<std::size_t>(kind);
      moving_[i].add(compare_images(compared.images.visibility, true_visibility, mask));
      static_[i].add(compare_images(still.visibility, true_visibility, mask));
    };
    add(MotionError::all, truths.surfaces);
    add(MotionError::uncovered, compared.uncovered);
    add(MotionError::near_object, surfaces_where(seen, [&](const glm::vec3& position) {
          return path_.is_near_object(position, compared.frame, kTrailFrames);
        }));
    const auto degrees = [&](const FrameImages& images) {
      return compare_directions(images.bent_normal_ws, truths.scene.bent_normal_ws, truths.surfaces)
                 .mean_degrees /
             kCompared;
    };
    report.bent_normal_degrees += degrees(compared.images);
    report.static_bent_normal_degrees += degrees(still);
    report.pictures.push_back({compared.frame, compared.images.visibility,
                               std::move(still.visibility), std::move(truths.scene.visibility)});
    return {};
  }

  // Measures the frames 1, 2, 4, ... after the cut, with the history kept and with it discarded.
  Result<MotionReport> run_cut() {
    MotionReport report;
    const std::uint32_t cut = path_.cut().value_or(0);
    ALCOVE_TRY(const auto renderer, create_renderer());
    // All frames with the history kept come first, because the device has one history.
    std::vector<PathFrame> compared;
    for (std::uint32_t frame = 0; frame < path_.frames(); ++frame) {
      const std::uint32_t since = frame + 1 - std::min(cut, frame + 1);
      if (since == 0 || (since & (since - 1)) != 0) {
        ALCOVE_TRY_VOID(renderer->draw(request(setup_.occlusion, frame)));
        continue;
      }
      ALCOVE_TRY(auto images, renderer->draw_and_read(request(setup_.occlusion, frame)));
      compared.push_back({frame, std::move(images), {}});
    }
    for (auto& [frame, kept, uncovered] : compared) {
      const std::uint32_t since = frame + 1 - cut;
      ALCOVE_TRY(auto restarted, draw_without_motion(frame, since));
      ALCOVE_TRY(auto truths, truth(frame, kept));
      const auto rmse = [&](const FrameImages& images) {
        return compare_images(images.visibility, truths.scene.visibility, truths.surfaces).rmse;
      };
      report.after_cut.push_back({since, rmse(kept), rmse(restarted)});
      report.pictures.push_back({frame, std::move(kept.visibility), std::move(restarted.visibility),
                                 std::move(truths.scene.visibility)});
    }
    return report;
  }

  Gpu& gpu_;
  Scene scene_;
  MotionPath path_;
  MotionSetup setup_;
  std::array<Squares, kMotionErrorNames.size()> moving_;
  std::array<Squares, kMotionErrorNames.size()> static_;
};

}  // namespace

Result<MotionReport> run_motion(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                const MotionSetup& setup) {
  return MotionRun(gpu, scene, path, setup).run();
}

}  // namespace alcove::sample
