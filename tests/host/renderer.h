// A renderer as public samples write it: a render pass for the g-buffer with automatic layout
// transitions, packed normals, depth with stencil, two frames in flight, and a second queue for
// asynchronous compute.
//
//   renderer_setup.cpp  creates and destroys what lives as long as the renderer
//   renderer.cpp        images of a size, the passes of a frame, submission
//   occlusion.cpp       everything that the renderer adds for Alcove, but for its two images
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "base.h"
#include "camera.h"
// Alcove: begin
#include <alcove/alcove.h>
// Alcove: end

namespace host {

inline constexpr std::uint32_t kSlots = 2;  // frames in flight
inline constexpr VkPipelineStageFlags kFragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

struct Options {
  glm::vec3 eye{};             // world space
  bool async = false;          // occlusion on a queue of its own, ordered by semaphores
  bool float_normals = false;  // R16G16B16A16_SFLOAT instead of A2B10G10R10_UNORM
};

// Returns the format of the image of normals.
inline VkFormat normal_format(const Options& options) {
  return options.float_normals ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_A2B10G10R10_UNORM_PACK32;
}

class Renderer {
 public:
  explicit Renderer(const Options& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Replaces the images by ones of this size.
  void resize(VkExtent2D size);
  // Draws a frame of the camera at `angle` radians about the vertical axis through the target.
  void draw(float angle);
  // Writes the visibility of the last frame as a PGM file.
  void write_visibility(const char* file);

 private:
  struct Slot {
    VkCommandBuffer geometry = VK_NULL_HANDLE;
    VkCommandBuffer compute = VK_NULL_HANDLE;  // between geometry and lighting
    VkCommandBuffer lighting = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;     // geometry has finished; with asynchronous compute
    VkSemaphore computed = VK_NULL_HANDLE;  // compute has finished; with asynchronous compute
    VkFence finished = VK_NULL_HANDLE;
  };
  void create_render_passes();
  void create_pipelines();
  void create_slots();
  void destroy_targets();
  void write_descriptors() const;
  void record_geometry(VkCommandBuffer commands, const CameraMatrices& camera) const;
  void record_lighting(VkCommandBuffer commands) const;
  void begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer target) const;
  void submit(const Slot& slot) const;

  Base base_;
  Options options_;
  VkExtent2D size_{};
  std::uint32_t frame_ = 0;         // since the last resize
  std::uint32_t still_frames_ = 0;  // frames in a row whose camera is that of the frame before
  CameraMatrices previous_{};
  Image depth_, normals_, visibility_, colour_;
  Buffer vertices_;
  std::uint32_t vertex_count_ = 0;
  VkRenderPass geometry_pass_ = VK_NULL_HANDLE, lighting_pass_ = VK_NULL_HANDLE;
  VkFramebuffer geometry_target_ = VK_NULL_HANDLE, lighting_target_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipelineLayout geometry_layout_ = VK_NULL_HANDLE, lighting_layout_ = VK_NULL_HANDLE;
  VkPipeline geometry_pipeline_ = VK_NULL_HANDLE, lighting_pipeline_ = VK_NULL_HANDLE;
  std::array<Slot, kSlots> slots_;

  // Occlusion, in occlusion.cpp.
  static void request_features(VkPhysicalDeviceFeatures2& features,
                               VkPhysicalDeviceVulkan13Features& features13);
  void create_occlusion();
  void destroy_occlusion() const;
  void forget_images() const;
  void record_occlusion(VkCommandBuffer commands, const CameraMatrices& camera) const;
  void require_no_mistakes() const;
  // Alcove: begin
  AlcoveContext* alcove_ = nullptr;
  // Alcove: end
};

}  // namespace host
