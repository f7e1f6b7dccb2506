#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu/gpu.h"
#include "render/frame_renderer.h"
#include "render/session.h"
#include "scene/scene.h"

namespace alcove::sample {

// Medians over the frames of a run.
struct Costs {
  std::vector<PassTime> passes;  // GPU timestamps, milliseconds
  double occlusion_ms = 0;       // of the occlusion passes together
  double cpu_ms = 0;             // processor time of all threads for them
};

// Everything that `alcove render` knows of what it drew; `compare` adds truths to it.
struct Rendering {
  Scene scene;
  double load_seconds = 0.0;  // of the scene
  Camera camera;              // of the last frame
  passes::OcclusionSettings settings;
  IndirectRequest light;
  // Of the last frame. Specular occlusion and what is lit with it are of a run of their own where
  // the settings want none.
  FrameImages images;
  Costs costs;                // by the settings as they are
  Costs costs_with_specular;  // and with specular occlusion
  framegraph::MemoryStatistics memory;
  std::string device;
  std::string driver;
};

// The model that specular occlusion is drawn by: slices where the settings want none.
[[nodiscard]] passes::Specular specular_model(const passes::OcclusionSettings& settings);

// Which frames of a session to draw, and what to make of the last one.
struct RenderRequest {
  std::uint32_t width = 960;  // pixels
  std::uint32_t height = 540;
  std::uint32_t frames = 1;
  float orbit = 0.0f;  // radians that the camera orbits its target by, per frame
  NormalSource normals = NormalSource::kShading;
  IndirectRequest light;
};

// Draws the frames and reads the last one back.
[[nodiscard]] tl::expected<Rendering, std::string> render(Session session,
                                                          const RenderRequest& request);

// Distance along the view axis, infinity in the sky.
[[nodiscard]] Image<float> linear_depth(const Rendering& rendering);

// The picture with the environment where the scene is not.
[[nodiscard]] Image<glm::vec3> with_sky(const Rendering& rendering, Image<glm::vec3> picture);

// What the specular occlusion of index `i` was made for: materials, or r30 for a roughness of 0.3.
[[nodiscard]] std::string roughness_name(const IndirectRequest& light, std::size_t i);

// The name of the specular occlusion of index `i` without its ending: specular_occlusion, followed
// by _r30 and the like where several roughness values were asked for.
[[nodiscard]] std::string specular_name(const IndirectRequest& light, std::size_t i);

// Writes the images of a rendering to a folder that exists.
[[nodiscard]] tl::expected<void, std::string> write_images(const Rendering& rendering,
                                                           const std::filesystem::path& folder);

}  // namespace alcove::sample
