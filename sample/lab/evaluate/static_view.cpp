#include "evaluate/static_view.h"

#include <algorithm>
#include <cmath>

namespace alcove::sample {

FrameRequest frame_request(const StaticSetup& setup, const OcclusionSettings& settings,
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
  request.occlusion.specular = ALCOVE_SPECULAR_NONE;
  request.occlusion.bent_normal = false;
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

}  // namespace alcove::sample
