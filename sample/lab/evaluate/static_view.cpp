#include "evaluate/static_view.h"

#include <algorithm>
#include <cmath>

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
                                const OcclusionSettings& settings) {
  ALCOVE_TRY(const auto renderer,
             FrameRenderer::create(gpu, scene, {setup.width, setup.height}, setup.normals));
  return draw_frames(*renderer, setup, settings);
}

StaticSetup with_guard_band(const StaticSetup& setup, VkExtent2D band) {
  StaticSetup wide = setup;
  wide.width += 2 * band.width;
  wide.height += 2 * band.height;
  const glm::vec2 scale = glm::vec2(wide.width, wide.height) / glm::vec2(setup.width, setup.height);
  Camera& camera = wide.camera;
  camera.fov_y = 2.0f * std::atan(scale.y * std::tan(0.5f * camera.fov_y));
  camera.ortho_height *= scale.y;
  camera.offset_ndc /= scale;
  return wide;
}

Image<float> without_guard_band(const Image<float>& image, VkExtent2D band) {
  Image<float> middle(image.width - 2 * band.width, image.height - 2 * band.height);
  for (std::uint32_t y = 0; y < middle.height; ++y)
    std::copy_n(&image.at(band.width, y + band.height), middle.width, &middle.at(0, y));
  return middle;
}

}  // namespace alcove::sample
