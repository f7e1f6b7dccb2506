#include "evaluate/variant.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "support/median.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;

FrameRequest make_request(const StaticSetup& setup, const OcclusionSettings& settings,
                          std::uint32_t frame) {
  const auto matrices = [&](std::uint32_t at) {
    const float angle =
        setup.orbit * (static_cast<float>(at) - static_cast<float>(setup.frames - 1));
    return camera_matrices(orbited(setup.camera, angle), setup.width, setup.height);
  };
  const CameraMatrices now = matrices(frame);
  const CameraMatrices before = setup.orbit == 0.0f ? now : matrices(std::max(frame, 1u) - 1);
  FrameRequest request;
  request.view = {now.view_from_world, now.clip_from_view, before.view_from_world,
                  before.clip_from_view, setup.camera.reversed_z};
  request.index = setup.first_frame + frame;
  request.restart = frame == 0;
  request.static_frames = setup.orbit == 0.0f ? frame : 0;
  request.occlusion = settings;
  request.occlusion.specular = passes::Specular::none;
  request.occlusion.bent_normal = false;
  return request;
}

Result<std::unique_ptr<FrameRenderer>> create_renderer(Gpu& gpu, const Scene& scene,
                                                       const StaticSetup& setup) {
  return FrameRenderer::create(gpu, scene, {setup.width, setup.height}, setup.normals);
}

Measurement measure_errors(const Variant& variant, const Image<float>& visibility,
                           const Truths& truths, const VariantCost& cost) {
  return {variant, compare_images(visibility, truths.scene.visibility, truths.surfaces),
          compare_images(visibility, truths.height_field.visibility, truths.surfaces), cost};
}

// Renders variants of a view alternately with its base.
class Experiment {
 public:
  Experiment(const Session& session, const StaticSetup& setup, const ChosenClock* clock)
      : session_(session), setup_(setup), clock_(clock) {}

  Result<std::vector<Measurement>> run(const TruthOptions& truth_options,
                                       const std::vector<Variant>& variants,
                                       const std::string& progress) {
    ALCOVE_TRY(base_, create_renderer(*session_.gpu, session_.scene, setup_));
    ALCOVE_TRY(const FrameImages images, draw_frames(*base_, setup_, session_.settings));
    ALCOVE_TRY(truths_, compute_truths({session_.scene, setup_.camera, session_.settings.radius,
                                        images.depth_ndc, images.normal_ws},
                                       truth_options));
    std::vector<Measurement> rows{measure_errors({"", "base settings", session_.settings},
                                                 images.visibility, truths_,
                                                 {.bytes = used_bytes(*base_)})};
    const Progress print = print_progress(progress);
    for (const Variant& variant : variants) {
      ALCOVE_TRY(auto row, measure(variant));
      rows.push_back(std::move(row));
      print(static_cast<double>(rows.size() - 1) / static_cast<double>(variants.size()));
    }
    ALCOVE_TRY_VOID(check_validation(*session_.gpu));
    if (clock_ != nullptr) ALCOVE_TRY_VOID(set_times(rows));
    return rows;
  }

 private:
  static std::uint64_t used_bytes(const FrameRenderer& renderer) {
    return renderer.memory().aliased + renderer.memory().history;
  }

  // Renders a variant on a device of its own, so that its histories start empty.
  Result<Measurement> measure(const Variant& variant) {
    ALCOVE_TRY(const auto gpu, open_gpu(session_.device));
    ALCOVE_TRY(const auto renderer, create_renderer(*gpu, session_.scene, setup_));
    ALCOVE_TRY(const FrameImages images, draw_frames(*renderer, setup_, variant.settings));
    const std::uint64_t bytes = used_bytes(*renderer);
    ALCOVE_TRY(const auto pairs, time_pairs(*renderer, variant.settings));
    ALCOVE_TRY_VOID(check_validation(*gpu));
    return measure_errors(variant, images.visibility, truths_, median_cost(pairs, bytes));
  }

  Result<std::vector<TimedPair>> time_pairs(FrameRenderer& variant,
                                            const OcclusionSettings& settings) {
    // Times that are only printed beside modelled ones need fewer pairs.
    const std::uint32_t count = clock_ == nullptr                  ? 0
                                : clock_->clock == Clock::modelled ? 11
                                                                   : kDecidingPairs;
    std::vector<TimedPair> pairs;
    // One pair before the timed ones is not counted, because it compiles shaders.
    for (std::uint32_t i = 0; count > 0 && i <= count; ++i) {
      ALCOVE_TRY(const FrameCost base, base_->draw(make_request(setup_, session_.settings,
                                                                setup_.frames + base_frames_++)));
      ALCOVE_TRY(const FrameCost other,
                 variant.draw(make_request(setup_, settings, setup_.frames + i)));
      if (i == 0) continue;
      base_gpu_ms_.push_back(base.occlusion_ms);
      base_processor_ms_.push_back(base.cpu_ms);
      pairs.push_back({{base.occlusion_ms, base.cpu_ms}, {other.occlusion_ms, other.cpu_ms}});
    }
    return pairs;
  }

  // Times are ratios to the base times the median of the base over all pairs.
  Result<void> set_times(std::vector<Measurement>& rows) const {
    const FrameTimes base{median(base_gpu_ms_), median(base_processor_ms_)};
    for (Measurement& row : rows) {
      row.processor_ms = row.cost.processor * base.processor_ms;
      if (clock_->clock == Clock::modelled) {
        ALCOVE_TRY(row.time_ms, clock_->model(row.variant.settings));
      } else if (clock_->clock == Clock::timestamps) {
        row.time_ms = row.cost.gpu * base.gpu_ms;
        row.spread_ms = row.cost.gpu_spread * base.gpu_ms;
      } else {
        row.time_ms = row.processor_ms;
        row.spread_ms = row.cost.processor_spread * base.processor_ms;
      }
    }
    return {};
  }

  const Session& session_;
  const StaticSetup& setup_;
  const ChosenClock* clock_;
  std::unique_ptr<FrameRenderer> base_;
  std::uint32_t base_frames_ = 0;  // drawn after StaticSetup::frames
  Truths truths_;
  std::vector<double> base_gpu_ms_;
  std::vector<double> base_processor_ms_;
};

}  // namespace

Result<FrameImages> draw_frames(FrameRenderer& renderer, const StaticSetup& setup,
                                const OcclusionSettings& settings) {
  for (std::uint32_t i = 0; i + 1 < setup.frames; ++i)
    ALCOVE_TRY_VOID(renderer.draw(make_request(setup, settings, i)));
  return renderer.draw_and_read(make_request(setup, settings, setup.frames - 1));
}

Result<FrameImages> draw_static(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                                const OcclusionSettings& settings) {
  ALCOVE_TRY(const auto renderer, create_renderer(gpu, scene, setup));
  return draw_frames(*renderer, setup, settings);
}

Result<Image<float>> draw_with_guard_band(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                                          const OcclusionSettings& settings, VkExtent2D band) {
  StaticSetup wide = setup;
  wide.width += 2 * band.width;
  wide.height += 2 * band.height;
  const glm::vec2 scale = glm::vec2(wide.width, wide.height) / glm::vec2(setup.width, setup.height);
  Camera& camera = wide.camera;
  camera.fov_y = 2.0f * std::atan(scale.y * std::tan(0.5f * camera.fov_y));
  camera.ortho_height *= scale.y;
  camera.offset_ndc /= scale;
  ALCOVE_TRY(const FrameImages images, draw_static(gpu, scene, wide, settings));
  Image<float> middle(setup.width, setup.height);
  for (std::uint32_t y = 0; y < setup.height; ++y)
    std::copy_n(&images.visibility.at(band.width, y + band.height), setup.width, &middle.at(0, y));
  return middle;
}

VariantCost median_cost(std::span<const TimedPair> pairs, std::uint64_t bytes) {
  VariantCost cost{.bytes = bytes};
  if (pairs.empty()) return cost;
  std::vector<double> gpu, processor;
  for (const TimedPair& pair : pairs) {
    gpu.push_back(pair.variant.gpu_ms / pair.base.gpu_ms);
    processor.push_back(pair.variant.processor_ms / pair.base.processor_ms);
  }
  cost.gpu = median(gpu);
  cost.processor = median(processor);
  cost.gpu_spread = quartile_spread(gpu);
  cost.processor_spread = quartile_spread(processor);
  return cost;
}

Result<std::vector<Measurement>> measure_variants(const Session& session, const StaticSetup& setup,
                                                  const TruthOptions& truth_options,
                                                  const std::vector<Variant>& variants,
                                                  const std::string& progress,
                                                  const ChosenClock* clock) {
  return Experiment(session, setup, clock).run(truth_options, variants, progress);
}

}  // namespace alcove::sample
