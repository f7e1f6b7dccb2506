#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alcove/framegraph/executor.h"
#include "gpu/gpu.h"
#include "gpu/gpu_image.h"
#include "render/gbuffer.h"
#include "render/light.h"
#include "render/read_back.h"
#include "render/session.h"
#include "render/surfaces.h"
#include "scene/environment.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// The images that a frame computes from visibility besides the occlusion itself, if its images are
// read back.
struct IndirectRequest {
  // The perceptual roughness values for which specular occlusion is computed, one image for each.
  // If empty, there is one image with the roughness of the materials.
  std::vector<float> roughness;
  // The environment that lights the scene; empty: the scene is not lit.
  EnvironmentImage environment;
  bool lit_steps = false;  // also render the lit images with less of the occlusion (LitImages)
};

// The view, the settings and the outputs of one frame.
struct FrameRequest {
  GbufferView view;
  std::uint32_t index = 0;          // number of the frame; 0 resets the histories
  bool restart = false;             // also resets the histories
  std::uint32_t static_frames = 0;  // see AlcoveViewInfo::static_frames
  // Whether the occlusion passes get motion vectors; if not, only the camera moves.
  bool motion_vectors = false;
  OcclusionSettings occlusion;
  const IndirectRequest* light = nullptr;  // null: nothing besides occlusion
};

// The times of a frame in milliseconds.
struct FrameCost {
  std::vector<PassTime> gpu;  // GPU time of each pass, g-buffer first
  double occlusion_ms = 0;    // sum of these times without the g-buffer
  double cpu_ms = 0;          // processor time of all threads for the occlusion passes
};

// Radiance towards the eye with the environment as the only light. Pixels of the sky show the
// environment, and are black in `diffuse` and `specular`.
struct LitImages {
  Image<glm::vec3> all;  // with all effects of the occlusion
  Image<glm::vec3> diffuse;
  Image<glm::vec3> specular;
  // Without occlusion; this and the following images only if IndirectRequest::lit_steps.
  Image<glm::vec3> unoccluded;
  Image<glm::vec3> unbent;    // diffuse light from along the normal, times visibility
  Image<glm::vec3> occluded;  // diffuse light from along the bent normal, times visibility
  // The light of `occluded` with multi-bounce, and specular light times visibility.
  Image<glm::vec3> bounced;
};

// The images of a frame, read back.
struct FrameImages {
  Image<float> depth_ndc;      // as the projection wrote it
  Image<glm::vec3> normal_ws;  // the normals that the occlusion passes got, or computed from depth
  Image<glm::vec3> albedo;     // linear
  Image<float> roughness;      // perceptual
  Image<float> metallic;
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;  // empty without bent normals, as are the next two
  Image<glm::vec3> multi_bounce;
  std::vector<Image<float>> specular_occlusion;  // one for each of IndirectRequest::roughness
  LitImages lit;                                 // empty without an environment
};

// Draws frames of one scene at one size, if it has a guard band with an invisible border of so many
// pixels, which FrameRequest::view and the images lack. First it draws a g-buffer, then it computes
// the occlusion. Each is submitted separately, so that the time of the occlusion can be measured.
class FrameRenderer {
 public:
  // Draws views of the size, normals and guard band of `view`; `guard_band`, in pixels, replaces
  // its own. The g-buffers of the last `kept_views` views are kept for frames that show them again.
  [[nodiscard]] static Result<std::unique_ptr<FrameRenderer>> create(
      Gpu& gpu, const Scene& scene, const ViewRequest& view, std::size_t kept_views = 1,
      std::optional<VkExtent2D> guard_band = {});

  // Draws a frame without reading images back. It is used for the frames before the one whose
  // images are needed.
  [[nodiscard]] Result<FrameCost> draw(const FrameRequest& request);
  // Draws a frame, lights it and reads its images back. It returns no times.
  [[nodiscard]] Result<FrameImages> draw_and_read(const FrameRequest& request);

  // Returns the memory of the occlusion passes' transients in the most recent frame.
  const framegraph::MemoryStatistics& memory() const { return memory_; }

 private:
  // The textures of a frame that computes occlusion.
  struct DeclaredFrame {
    Surfaces surfaces;
    Occlusion outputs;
    std::vector<framegraph::Texture> specular_occlusion;
  };

  // A g-buffer and the view that it shows.
  struct StoredGbuffer {
    std::optional<GbufferView> view;  // null before the first drawing
    HiddenDepths depths;              // the hidden depths that were drawn for that view
    std::vector<PassTime> times;      // of the drawing
    std::array<std::unique_ptr<GpuImage>, kGbufferTargets.size()> targets;
  };

  FrameRenderer(Gpu& gpu, VkExtent2D size, NormalSource normals, std::size_t kept_views,
                VkExtent2D guard_band)
      : gpu_(gpu), size_(size), guard_band_(guard_band), normals_(normals), stored_(kept_views) {}
  // Returns the request with the view that is drawn.
  [[nodiscard]] FrameRequest with_band(FrameRequest request) const {
    request.view = with_guard_band(request.view, size_, guard_band_);
    return request;
  }
  Result<std::unique_ptr<GpuImage>> create_target(VkFormat format);
  // Returns whether the texture of this target is drawn for these hidden depths.
  static bool is_drawn(const GbufferTarget& target, const HiddenDepths& hidden);
  // Draws the g-buffer, unless one with the same view and the same previous view is kept.
  Result<void> draw_gbuffer(const FrameRequest& request, FrameCost& cost);
  Result<DeclaredFrame> declare_occlusion(framegraph::Graph& graph, const FrameRequest& request);
  // Reads back the textures of declare_occlusion() and, below, of the passes that it adds.
  static void read_occlusion(framegraph::Graph& graph, const DeclaredFrame& declared,
                             ReadBack& read_back, FrameImages& images);
  static void declare_light(framegraph::Graph& graph, const FrameRequest& request,
                            const DeclaredFrame& declared, const Light& light, ReadBack& read_back,
                            FrameImages& images);
  void append_times(FrameCost& cost, bool occlusion);

  Gpu& gpu_;
  VkExtent2D size_;  // without the guard band
  VkExtent2D guard_band_;
  NormalSource normals_;
  std::unique_ptr<GbufferRenderer> gbuffer_;
  std::vector<StoredGbuffer> stored_;
  std::size_t current_ = 0;  // the g-buffer of the last frame
  framegraph::MemoryStatistics memory_;
};

}  // namespace alcove::sample
