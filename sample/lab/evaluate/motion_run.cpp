#include "evaluate/motion_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "render/frame_renderer.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kCompared = 3;  // frames of a path

// A frame of the path.
struct ComparedFrame {
  std::uint32_t frame = 0;
  FrameImages images;
  RenderedFrame seen;
  Image<std::uint32_t> ages;
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
    RunningMean change, unfiltered, speed;
    std::vector<ComparedFrame> compared;
    const auto measure = [&](const ComparedFrame& now, const RunningMean& changed,
                             const Reprojection& reprojection) {
      speed += measure_speed(reprojection);
      if (now.frame >= first_converged()) change += changed;
      if (is_compared(now.frame)) compared.push_back(now);
    };
    ALCOVE_TRY_VOID(render_path(setup_.occlusion, measure));
    OcclusionSettings no_history = setup_.occlusion;
    no_history.history_frames = 0;
    ALCOVE_TRY_VOID(render_path(no_history, [&](const ComparedFrame&, const RunningMean& changed,
                                                const Reprojection&) { unfiltered += changed; }));
    report.speed = speed.mean();
    report.flicker = {change.mean(), unfiltered.mean()};
    for (const ComparedFrame& frame : compared) ALCOVE_TRY_VOID(compare(frame, report));
    for (std::size_t i = 0; i < report.errors.size(); ++i)
      report.errors[i] = {moving_[i].count, moving_[i].root(), static_[i].root()};
    return report;
  }

 private:
  std::uint32_t first_converged() const { return path_.frames() / kCompared; }
  bool is_compared(std::uint32_t frame) const {
    for (std::uint32_t i = 1; i <= kCompared; ++i)
      if (frame + 1 == i * path_.frames() / kCompared) return true;
    return false;
  }

  Result<std::unique_ptr<FrameRenderer>> create_renderer() {
    return FrameRenderer::create(gpu_, scene_, {setup_.view.width, setup_.view.height},
                                 setup_.view.normals);
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

  // Called for each frame but the first with its change of visibility since the frame before.
  using Visit = std::function<void(const ComparedFrame& now, const RunningMean& changed,
                                   const Reprojection& reprojection)>;

  // Draws the frames of the path. The frames before the first measured one are drawn only if there
  // is a history to fill.
  Result<void> render_path(const OcclusionSettings& settings, const Visit& visit) {
    const bool history = settings.history_frames > 0;
    const Progress progress =
        print_progress(std::string(name_of(path_.kind())) + (history ? "" : " without history"));
    const std::uint32_t first = history ? 0 : first_converged() - 1;
    ALCOVE_TRY(const auto renderer, create_renderer());
    std::optional<ComparedFrame> last;
    for (std::uint32_t frame = first; frame < path_.frames(); ++frame) {
      ALCOVE_TRY(auto images, renderer->draw_and_read(request(settings, frame)));
      const Camera camera = path_.camera(frame);
      RenderedFrame seen{camera, linear_depth(camera, images.depth_ndc), images.normal_ws,
                         images.visibility};
      ComparedFrame now{frame, std::move(images), std::move(seen), {}};
      now.ages = first_ages(now.seen);
      if (last) {
        const Reprojection reprojection = reproject(
            now.seen, last->seen,
            [&](const glm::vec3& position) { return path_.position_before(position, frame); });
        now.ages = next_ages(now.seen, reprojection, last->ages);
        visit(now, visibility_change(now.seen.visibility, last->seen.visibility, reprojection),
              reprojection);
      }
      last = std::move(now);
      progress(static_cast<double>(frame + 1 - first) / (path_.frames() - first));
    }
    return {};
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
  Result<void> compare(const ComparedFrame& compared, MotionReport& report) {
    ALCOVE_TRY(auto still, draw_without_motion(compared.frame, compared.frame + 1));
    ALCOVE_TRY(auto truths, truth(compared.frame, compared.images));
    const Image<float>& true_visibility = truths.scene.visibility;
    const auto add = [&](MotionError kind, const Mask& mask) {
      const auto i = static_cast<std::size_t>(kind);
      moving_[i].add(compare_images(compared.images.visibility, true_visibility, mask));
      static_[i].add(compare_images(still.visibility, true_visibility, mask));
    };
    Mask uncovered(truths.surfaces.width, truths.surfaces.height);
    std::ranges::transform(compared.ages.pixels, uncovered.pixels.begin(),
                           [](std::uint32_t age) { return age == kNewFrames ? 1 : 0; });
    add(MotionError::all, truths.surfaces);
    add(MotionError::uncovered, uncovered);
    add(MotionError::near_object, surfaces_where(compared.seen, [&](const glm::vec3& position) {
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
    for (std::uint32_t frame = 0; frame < path_.frames(); ++frame) {
      const std::uint32_t since = frame + 1 - std::min(cut, frame + 1);
      if (since == 0 || (since & (since - 1)) != 0) {
        ALCOVE_TRY_VOID(renderer->draw(request(setup_.occlusion, frame)));
        continue;
      }
      ALCOVE_TRY(auto kept, renderer->draw_and_read(request(setup_.occlusion, frame)));
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
