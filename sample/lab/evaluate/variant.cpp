#include "evaluate/variant.h"

#include <algorithm>
#include <utility>

#include "support/median.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using passes::OcclusionSettings;

FrameRequest request_of(const StaticSetup& setup, const OcclusionSettings& settings,
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

std::uint64_t bytes_of(const FrameRenderer& renderer) {
  const framegraph::MemoryStatistics& memory = renderer.memory();
  return memory.aliased + memory.history;
}

}  // namespace

tl::expected<FrameImages, std::string> draw_frames(FrameRenderer& renderer,
                                                   const StaticSetup& setup,
                                                   const OcclusionSettings& settings) {
  for (std::uint32_t i = 0; i + 1 < setup.frames; ++i) {
    if (auto cost = renderer.draw(request_of(setup, settings, i)); !cost) {
      return Failure(std::move(cost.error()));
    }
  }
  return renderer.draw_and_read(request_of(setup, settings, setup.frames - 1));
}

VariantCost cost_of(std::span<const TimedPair> pairs, std::uint64_t bytes) {
  VariantCost cost{.bytes = bytes};
  if (pairs.empty()) {
    return cost;
  }
  std::vector<double> gpu;
  std::vector<double> processor;
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

tl::expected<FrameImages, std::string> draw_static(Gpu& gpu, const Scene& scene,
                                                   const StaticSetup& setup,
                                                   const OcclusionSettings& settings) {
  const auto renderer =
      FrameRenderer::create(gpu, scene, {setup.width, setup.height}, setup.normals);
  if (!renderer) {
    return Failure(renderer.error());
  }
  return draw_frames(**renderer, setup, settings);
}

tl::expected<VariantRunner, std::string> VariantRunner::create(Gpu& gpu, const Scene& scene,
                                                               const StaticSetup& setup,
                                                               const OcclusionSettings& base) {
  VariantRunner made(scene, setup, base);
  auto renderer = FrameRenderer::create(gpu, scene, {setup.width, setup.height}, setup.normals);
  if (!renderer) {
    return Failure(std::move(renderer.error()));
  }
  made.renderer_ = std::move(*renderer);
  auto images = draw_frames(*made.renderer_, setup, base);
  if (!images) {
    return Failure(std::move(images.error()));
  }
  made.base_ = std::move(*images);
  made.next_frame_ = setup.frames;
  return made;
}

std::uint64_t VariantRunner::base_bytes() const { return bytes_of(*renderer_); }

BaseTimes VariantRunner::base_times() const {
  return {median(base_gpu_ms_), median(base_processor_ms_)};
}

tl::expected<VariantResult, std::string> VariantRunner::run(Gpu& gpu, const Variant& variant,
                                                            std::uint32_t timed_pairs) {
  const auto renderer =
      FrameRenderer::create(gpu, scene_, {setup_.width, setup_.height}, setup_.normals);
  if (!renderer) {
    return Failure(renderer.error());
  }
  auto images = draw_frames(**renderer, setup_, variant.settings);
  if (!images) {
    return Failure(std::move(images.error()));
  }
  VariantResult result{std::move(images->visibility), {.bytes = bytes_of(**renderer)}};
  if (timed_pairs == 0) {
    return result;
  }
  std::vector<TimedPair> pairs;
  // One pair before the timed ones is not counted, because it compiles shaders.
  for (std::uint32_t i = 0; i <= timed_pairs; ++i) {
    const auto base = renderer_->draw(request_of(setup_, settings_, next_frame_++));
    if (!base) {
      return Failure(base.error());
    }
    const auto other = (*renderer)->draw(request_of(setup_, variant.settings, setup_.frames + i));
    if (!other) {
      return Failure(other.error());
    }
    if (i > 0) {
      base_gpu_ms_.push_back(base->occlusion_ms);
      base_processor_ms_.push_back(base->cpu_ms);
      pairs.push_back({{base->occlusion_ms, base->cpu_ms}, {other->occlusion_ms, other->cpu_ms}});
    }
  }
  result.cost = cost_of(pairs, bytes_of(**renderer));
  return result;
}

}  // namespace alcove::sample
