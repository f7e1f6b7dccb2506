#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "render/gpu_meshes.h"
#include "render/gpu_textures.h"
#include "render/graphics.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// The camera of a frame as matrices, from world to view space and to Vulkan clip space, and the
// placement of the meshes that move.
struct GbufferView {
  glm::mat4 view_from_world{1.0f};
  glm::mat4 clip_from_view{1.0f};
  glm::mat4 previous_view_from_world{1.0f};
  glm::mat4 previous_clip_from_view{1.0f};
  bool reversed_z = false;
  glm::mat4 world_from_moving{1.0f};  // rotation and translation of each Mesh::moves
  glm::mat4 previous_world_from_moving{1.0f};

  bool operator==(const GbufferView&) const = default;
};

// Returns the view of a camera; `before` is the camera of the previous frame.
[[nodiscard]] GbufferView gbuffer_view(const Camera& now, const Camera& before, VkExtent2D size);

// Returns the width of a guard band, a part of the image beyond each border that is not displayed:
// an even number of pixels. `percent` is of the image's height.
[[nodiscard]] std::uint32_t guard_band_pixels(double percent, std::uint32_t height);
// Returns the view of an image of `size`, as one with a guard band of this many pixels shows it.
[[nodiscard]] GbufferView with_guard_band(GbufferView view, VkExtent2D size, VkExtent2D band);

// The textures that the rasterisation of a frame writes. A texture that is null is not kept. Depth
// is required.
struct Gbuffer {
  framegraph::Texture depth;       // as the projection writes it; sky at the far plane
  framegraph::Texture normal;      // xyz unit, world space, towards the eye
  framegraph::Texture albedo;      // linear RGB, alpha perceptual roughness
  framegraph::Texture motion;      // uv in this frame minus uv in the previous frame
  framegraph::Texture emissive;    // linear RGB, alpha metallic
  framegraph::Texture back_depth;  // depth of the nearest back faces of all materials
  // The second depth layer: the nearest front faces of all materials that lie behind `depth` by
  // more than a thousandth of its distance.
  framegraph::Texture second_depth;
};

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kAlbedoFormat = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat kMotionFormat = VK_FORMAT_R16G16_SFLOAT;
inline constexpr VkFormat kEmissiveFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// Each texture of a Gbuffer with its format.
struct GbufferTarget {
  framegraph::Texture Gbuffer::*texture;
  VkFormat format;
  const char* name;
};
inline constexpr std::array<GbufferTarget, 7> kGbufferTargets{
    {{&Gbuffer::depth, kDepthFormat, "depth"},
     {&Gbuffer::normal, kNormalFormat, "normals"},
     {&Gbuffer::albedo, kAlbedoFormat, "albedo"},
     {&Gbuffer::motion, kMotionFormat, "motion"},
     {&Gbuffer::emissive, kEmissiveFormat, "emissive"},
     {&Gbuffer::back_depth, kDepthFormat, "back-face depth"},
     {&Gbuffer::second_depth, kDepthFormat, "second depth"}}};

// Draws the g-buffer of a scene. Owns the meshes, textures and pipelines of the scene on one
// device. Back faces of materials that are not double-sided are culled.
class GbufferRenderer {
 public:
  // Uploads the scene. If `geometric_normals` is true, each triangle is drawn with its own
  // geometric normal instead of the interpolated normal with the normal map. Both references must
  // outlive the renderer.
  [[nodiscard]] static Result<std::unique_ptr<GbufferRenderer>> create(Gpu& gpu, const Scene& scene,
                                                                       bool geometric_normals);
  ~GbufferRenderer();

  // Adds the passes that fill `targets`, and returns their filled versions. All calls in one frame
  // must have the same view, because only one set of parameters is kept for each frame in flight.
  [[nodiscard]] Gbuffer add(framegraph::Graph& graph, const GbufferView& view,
                            const Gbuffer& targets);

 private:
  // The state with which the scene is drawn in one pass.
  struct Drawing {
    bool reversed_z = false;
    std::uint32_t parameters_offset = 0;
    VkCullModeFlags culled = VK_CULL_MODE_BACK_BIT;     // of single-sided materials
    VkCullModeFlags double_culled = VK_CULL_MODE_NONE;  // of double-sided ones
    // Depth of the first layer, which the pass of the second layer reads; may be null.
    framegraph::Texture first;
  };

  explicit GbufferRenderer(Gpu& gpu) : gpu_(gpu), layout_(gpu.device().device()) {}
  Result<void> upload(const Scene& scene);
  VkResult create_layout(const Scene& scene);
  VkResult create_pipelines(std::size_t first_index, bool geometric_normals);
  // Writes the parameters of a view, and returns their offset in the parameter buffer.
  std::uint32_t write_parameters(const GbufferView& view);
  // Adds a pass that fills the depth and the colours of `drawn` that are not null.
  Gbuffer add_pass(framegraph::Graph& graph, const char* name, Gbuffer drawn,
                   const Drawing& drawing);
  void record(framegraph::RecordContext& context, const Gbuffer& gbuffer,
              const Drawing& drawing) const;

  Gpu& gpu_;
  std::vector<bool> double_sided_;  // by material
  std::unique_ptr<GpuMeshes> meshes_;
  std::unique_ptr<GpuTextures> textures_;
  std::unique_ptr<HostBuffer> materials_;   // GbufferMaterial at multiples of kMaterialStride
  std::unique_ptr<HostBuffer> parameters_;  // one set of parameters for each frame in flight
  std::optional<GbufferView> written_;      // the view that was written most recently
  std::uint32_t latest_ = 0;                // offset of its parameters
  PipelineLayout layout_;
  std::array<VkPipeline, 6> pipelines_{};
};

}  // namespace alcove::sample
