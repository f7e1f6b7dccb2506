// A view that is rendered with any settings.
#pragma once

#include <cstdint>
#include <optional>

#include "gpu/occlusion.h"
#include "render/frame_renderer.h"
#include "render/session.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// A view, the last frame of which is evaluated. An orbit ends at the camera.
struct StaticSetup : ViewRequest {
  Camera camera;
  std::uint32_t first_frame = 0;  // number of the first frame; others have another noise
};

// Returns the request for a frame of the view: visibility, and bent normals if the settings have
// them, with motion relative to the frame before.
[[nodiscard]] FrameRequest frame_request(const StaticSetup& setup,
                                         const OcclusionSettings& settings, std::uint32_t frame);

// Renders the frames of a view and reads the last one back. `guard_band`, in pixels, replaces that
// of the view.
[[nodiscard]] Result<FrameImages> draw_frames(FrameRenderer& renderer, const StaticSetup& setup,
                                              const OcclusionSettings& settings);
[[nodiscard]] Result<FrameImages> draw_static(Gpu& gpu, const Scene& scene,
                                              const StaticSetup& setup,
                                              const OcclusionSettings& settings,
                                              std::optional<VkExtent2D> guard_band = {});

}  // namespace alcove::sample
