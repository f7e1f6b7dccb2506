#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "render/graphics.h"
#include "render/shaders/picture.h"
#include "support/glm.h"

namespace alcove::sample {

// The textures that the window shows. All have the size of the window.
struct PictureInputs {
  std::uint32_t show = maths::kShowGrey;
  framegraph::Texture texture;
  framegraph::Texture other;  // shown right of `split`; null without a comparison
  float split = 0.0f;         // in pixels from the left
  framegraph::Texture
      linear_depth;  // for radiance: the environment is shown at pixels without a surface
  framegraph::Texture environment;   // for radiance: the map of a probe
  glm::mat3 world_from_shown{1.0f};  // for directions and radiance, see PictureParameters
  float scale = 1.0f;                // see PictureParameters
};

// A pass that draws a picture over the whole image of a window.
class PicturePass {
 public:
  // `format` is the format of the window's images. The Gpu must outlive the pass.
  [[nodiscard]] static tl::expected<std::unique_ptr<PicturePass>, std::string> create(
      Gpu& gpu, VkFormat format);
  ~PicturePass();

  // Returns the version of `target` after the pass. To be called once per frame.
  [[nodiscard]] framegraph::Texture add(framegraph::Graph& graph, framegraph::Texture target,
                                        const PictureInputs& inputs);

 private:
  explicit PicturePass(VkDevice device) : device_(device), layout_(device) {}
  void record(framegraph::RecordContext& context, framegraph::Texture target,
              const PictureInputs& inputs) const;

  VkDevice device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  PipelineLayout layout_;  // one set for each frame slot
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace alcove::sample
