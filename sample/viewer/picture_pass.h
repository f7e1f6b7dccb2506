#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "render/shaders/picture.h"
#include "support/glm.h"

namespace alcove::sample {

// The textures that are shown. All are as large as the window.
struct Shown {
  std::uint32_t show = maths::kShowGrey;
  framegraph::Texture texture;
  framegraph::Texture other;         // shown right of `split`; null: nothing is
  float split = 0.0f;                // in pixels from the left
  framegraph::Texture linear_depth;  // of radiance; where it has the sky, the environment is shown
  framegraph::Texture environment;   // of radiance: a probe's map
  glm::mat3 world_from_shown{1.0f};  // of directions and radiance, as PictureParameters has them
  float scale = 1.0f;                // the same
};

// The pass that draws a picture on the whole of a window's image.
class PicturePass {
 public:
  // `format` is the window's; the Gpu must outlive the pass.
  [[nodiscard]] static tl::expected<std::unique_ptr<PicturePass>, std::string> create(
      Gpu& gpu, VkFormat format);
  ~PicturePass();
  PicturePass(const PicturePass&) = delete;
  PicturePass& operator=(const PicturePass&) = delete;

  // Returns the drawn version of `target`. Once a frame.
  [[nodiscard]] framegraph::Texture add(framegraph::Graph& graph, framegraph::Texture target,
                                        const Shown& shown);

 private:
  explicit PicturePass(const VulkanDevice& device) : device_(device) {}
  VkResult create_layout();
  VkResult create_pipeline(VkFormat format);
  VkResult create_sets(std::uint32_t count);
  void record(framegraph::RecordContext& context, framegraph::Texture target,
              const Shown& shown) const;

  const VulkanDevice& device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets_;  // by frame slot
};

}  // namespace alcove::sample
