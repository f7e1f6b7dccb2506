#include "evaluate/static_view.h"

#include <algorithm>

namespace alcove::sample {

FrameRequest frame_request(const StaticSetup& setup, const OcclusionSettings& settings,
                           std::uint32_t frame) {
  const auto camera = [&](std::uint32_t at) {
    return orbited(setup.camera,
                   setup.orbit * (static_cast<float>(at) - static_cast<float>(setup.frames - 1)));
  };
  FrameRequest request;
  request.view =
      gbuffer_view(camera(frame), camera(std::max(frame, 1u) - 1), {setup.width, setup.height});
  request.index = setup.first_frame + frame;
  request.restart = frame == 0;
  request.static_frames = setup.orbit == 0.0f ? frame : 0;
  request.occlusion = settings;
  request.occlusion.specular = ALCOVE_SPECULAR_NONE;
  return request;
}

Result<FrameImages> draw_frames(FrameRenderer& renderer, const StaticSetup& setup,
                                const OcclusionSettings& settings) {
  for (std::uint32_t i = 0; i + 1 < setup.frames; ++i)
    ALCOVE_TRY_VOID(renderer.draw(frame_request(setup, settings, i)));
  return renderer.draw_and_read(frame_request(setup, settings, setup.frames - 1));
}

Result<FrameImages> draw_static(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                                const OcclusionSettings& settings,
                                std::optional<VkExtent2D> guard_band) {
  ALCOVE_TRY(const auto renderer, FrameRenderer::create(gpu, scene, setup, 1, guard_band));
  return draw_frames(*renderer, setup, settings);
}

}  // namespace alcove::sample
