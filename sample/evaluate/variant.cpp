#include "evaluate/variant.h"

#include <utility>

#include "support/median.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using passes::OcclusionSettings;

// Timed pairs of frames. One pair before them is not timed, because it compiles shaders.
constexpr std::uint32_t kTimedPairs = 11;

FrameRequest request_of(const StaticSetup& setup, const OcclusionSettings& settings,
                        std::uint32_t frame) {
  const CameraMatrices m = camera_matrices(setup.camera, setup.width, setup.height);
  FrameRequest request;
  request.view = {m.view_from_world, m.clip_from_view, m.view_from_world, m.clip_from_view,
                  setup.camera.reversed_z};
  request.index = frame;
  request.static_frames = frame;
  request.occlusion = settings;
  request.occlusion.specular = passes::Specular::none;
  request.occlusion.bent_normal = false;
  return request;
}

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

std::uint64_t bytes_of(const FrameRenderer& renderer) {
  const framegraph::MemoryStatistics& memory = renderer.memory();
  return memory.aliased + memory.history;
}

}  // namespace

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
                                                            bool timed) {
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
  if (!timed) {
    return result;
  }
  std::vector<double> gpu_ratios;
  std::vector<double> processor_ratios;
  for (std::uint32_t i = 0; i <= kTimedPairs; ++i) {
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
      gpu_ratios.push_back(other->occlusion_ms / base->occlusion_ms);
      processor_ratios.push_back(other->cpu_ms / base->cpu_ms);
    }
  }
  result.cost = {median(gpu_ratios), median(processor_ratios), bytes_of(**renderer),
                 quartile_spread(gpu_ratios), quartile_spread(processor_ratios)};
  return result;
}

}  // namespace alcove::sample
