#pragma once

#include <string>
#include <vector>

#include "gpu/gpu.h"
#include "render/frame_renderer.h"
#include "render/session.h"
#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// Median times over the last frames of a run.
struct Costs {
  std::vector<PassTime> passes;  // GPU timestamps, milliseconds
  double occlusion_ms = 0;       // sum over the occlusion passes
  double cpu_ms = 0;             // processor time of all threads for the occlusion passes
};

// The result of a run of `alcove render`: the scene, the settings, the images and the times.
// `compare` adds references to it.
struct Rendering {
  Scene scene;
  double load_seconds = 0.0;  // time that loading the scene took
  Camera camera;              // in the last frame
  OcclusionSettings settings;
  IndirectRequest light;
  // The images of the last frame. If the settings have no specular occlusion, specular occlusion
  // and the images lit with it come from a second run.
  FrameImages images;
  Costs costs;  // with the settings as given
  framegraph::MemoryStatistics memory;
  std::string device;
  std::string driver;
};

// Draws the frames and reads the last one back, with the outputs that `light` requests.
[[nodiscard]] Result<Rendering> render(Session session, const ViewRequest& request,
                                       IndirectRequest light);

// Returns the distance along the view axis at each pixel, infinity at pixels of the sky.
[[nodiscard]] Image<float> linear_depth(const Rendering& rendering);

// Returns whether a pixel shows a surface.
[[nodiscard]] bool shows_surfaces(const Rendering& rendering);

// Returns the picture with the environment at pixels without a surface.
[[nodiscard]] Image<glm::vec3> with_sky(const Rendering& rendering, Image<glm::vec3> picture);

// Returns the name of the roughness for which the specular occlusion of index `i` was computed:
// `materials`, or for example `r30` for a roughness of 0.3.
[[nodiscard]] std::string roughness_name(const IndirectRequest& light, std::size_t i);

// Writes the images of a rendering to a folder that exists.
[[nodiscard]] Result<void> write_images(const Rendering& rendering,
                                        const std::filesystem::path& folder);

}  // namespace alcove::sample
