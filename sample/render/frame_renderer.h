#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/executor.h"
#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"
#include "render/gbuffer.h"
#include "render/normal_source.h"
#include "scene/environment.h"
#include "support/image.h"

namespace alcove::sample {

// What is made of visibility in a frame that is read back.
struct IndirectRequest {
  std::vector<float> roughness;  // perceptual, an image each; empty: one, of the materials' own
  EnvironmentImage environment;  // that lights the scene; empty: it is not lit
  bool lit_steps = false;        // also light it with less and less of the occlusion
};

// What one frame is drawn with.
struct FrameRequest {
  GbufferView view;
  std::uint32_t index = 0;          // counts frames; 0 begins anew
  bool restart = false;             // begins anew too: nothing of the frames before is kept
  std::uint32_t static_frames = 0;  // as passes::Frame has them
  bool motion_vectors = false;      // the occlusion is given them; else only the camera moves
  passes::OcclusionSettings occlusion;
  const IndirectRequest* light = nullptr;  // null: none
};

// What a frame cost.
struct FrameCost {
  std::vector<PassTime> gpu;  // each pass by GPU timestamps, g-buffer first
  double occlusion_ms = 0;    // their sum without the g-buffer
  double cpu_ms = 0;          // processor time of all threads for the occlusion passes
};

// Radiance towards the eye under the environment, zero in the sky.
struct LitImages {
  Image<glm::vec3> all;  // with all that is known of occlusion
  Image<glm::vec3> diffuse;
  Image<glm::vec3> specular;
  Image<glm::vec3> unoccluded;  // this and the rest by IndirectRequest::lit_steps
  Image<glm::vec3> unbent;      // diffuse light times visibility
  Image<glm::vec3> occluded;    // the same, from along the bent normal
  Image<glm::vec3> bounced;     // that times multi-bounce instead, and specular light alike
};

// The images of a frame, read back.
struct FrameImages {
  Image<float> depth_ndc;      // as the projection wrote it
  Image<glm::vec3> normal_ws;  // what the occlusion was given, or made from depth
  Image<glm::vec3> albedo;     // linear
  Image<float> roughness;      // perceptual
  Image<float> metallic;
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;  // empty without bent normals, as are the next two
  Image<glm::vec3> multi_bounce;
  std::vector<Image<float>> specular_occlusion;  // by IndirectRequest::roughness
  LitImages lit;                                 // empty without an environment
};

// Draws frames of one scene at one size: a g-buffer, then occlusion on it, each a submission of its
// own so that the cost of the second can be told.
class FrameRenderer {
 public:
  [[nodiscard]] static tl::expected<std::unique_ptr<FrameRenderer>, std::string> create(
      Gpu& gpu, const Scene& scene, VkExtent2D size, NormalSource normals);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  // Draws a frame and forgets its images: for what comes before the one that is wanted.
  [[nodiscard]] tl::expected<FrameCost, std::string> draw(const FrameRequest& request);
  // Draws a frame, lights it and reads its images back. What that costs is not counted.
  [[nodiscard]] tl::expected<FrameImages, std::string> draw_and_read(const FrameRequest& request);

  // Bytes of the occlusion's transients in the frame drawn last.
  const framegraph::MemoryStatistics& memory() const;

 private:
  struct State;
  explicit FrameRenderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::sample
