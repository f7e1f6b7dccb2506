// A view that is rendered with any settings.
#pragma once

#include <cstdint>

#include "gpu/occlusion.h"
#include "render/frame_renderer.h"
#include "render/normal_source.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// A view and how it is rendered.
struct StaticSetup {
  Camera camera;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t frames = 32;  // at least 1; the last one is evaluated
  NormalSource normals = NormalSource::shading;
  std::uint32_t first_frame = 0;  // number of the first frame; others have another noise
  float orbit = 0;                // radians per frame, of an orbit that ends at the camera
  VkExtent2D guard_band{};        // pixels beyond each border, which are drawn and not evaluated
};

// Returns the request for a frame of the view: visibility, and bent normals if the settings have
// them, with motion relative to the frame before.
[[nodiscard]] FrameRequest frame_request(const StaticSetup& setup,
                                         const OcclusionSettings& settings, std::uint32_t frame);

// Renders the frames of a view and reads the last one back.
[[nodiscard]] Result<FrameImages> draw_frames(FrameRenderer& renderer, const StaticSetup& setup,
                                              const OcclusionSettings& settings);
[[nodiscard]] Result<FrameImages> draw_static(Gpu& gpu, const Scene& scene,
                                              const StaticSetup& setup,
                                              const OcclusionSettings& settings);

}  // namespace alcove::sample
