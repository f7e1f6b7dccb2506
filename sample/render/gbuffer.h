#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "scene/scene.h"

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

// The textures that the rasterisation of a frame writes, with the formats named here. A texture
// that is null is not drawn. Depth is required.
struct Gbuffer {
  framegraph::Texture depth;     // D32_SFLOAT, as the projection writes it; sky at the far plane
  framegraph::Texture normal;    // RGBA16_SFLOAT, xyz unit, world space, towards the eye
  framegraph::Texture albedo;    // RGBA8_UNORM: linear RGB, alpha perceptual roughness
  framegraph::Texture motion;    // RG16_SFLOAT: uv in this frame minus uv in the previous frame
  framegraph::Texture emissive;  // RGBA16_SFLOAT: linear RGB, alpha metallic
};

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kAlbedoFormat = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat kMotionFormat = VK_FORMAT_R16G16_SFLOAT;
inline constexpr VkFormat kEmissiveFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// Draws the g-buffer of a scene. Owns the meshes, textures and pipelines of the scene on one
// device. Back faces of materials that are not double-sided are culled.
class GbufferRenderer {
 public:
  // Uploads the scene. If `geometric_normals` is true, each triangle is drawn with its own
  // geometric normal instead of the interpolated normal with the normal map. Both references must
  // outlive the renderer.
  [[nodiscard]] static tl::expected<std::unique_ptr<GbufferRenderer>, std::string> create(
      Gpu& gpu, const Scene& scene, bool geometric_normals);
  ~GbufferRenderer();
  GbufferRenderer(const GbufferRenderer&) = delete;
  GbufferRenderer& operator=(const GbufferRenderer&) = delete;

  // Adds the pass that fills `targets`, and returns their filled versions. All calls in one frame
  // must have the same view, because only one set of parameters is kept for each frame in flight.
  [[nodiscard]] Gbuffer add(framegraph::Graph& graph, const GbufferView& view,
                            const Gbuffer& targets);
  // Adds the pass that fills `depth`, a texture like Gbuffer::depth, with the nearest back faces of
  // all materials. `view` must be the same as in add().
  [[nodiscard]] framegraph::Texture add_back_faces(framegraph::Graph& graph,
                                                   const GbufferView& view,
                                                   framegraph::Texture depth);
  // Adds the pass that fills a texture like Gbuffer::depth with the second depth layer: the nearest
  // front faces of all materials that lie behind `first` by more than a thousandth of its distance.
  // `first` is the Gbuffer::depth of the same view.
  [[nodiscard]] framegraph::Texture add_second_layer(framegraph::Graph& graph,
                                                     const GbufferView& view,
                                                     framegraph::Texture first,
                                                     framegraph::Texture depth);

 private:
  struct State;
  explicit GbufferRenderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::sample
