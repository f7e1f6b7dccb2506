#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gpu/gpu.h"
#include "render/graphics.h"
#include "support/result.h"

namespace alcove::sample {

// A pass that runs a fragment shader at every pixel of its targets. The shader has an array of
// images in binding 0, a sampler in binding 1, and its parameters as push constants.
class FullScreenPass {
 public:
  struct Description {
    const char* name;
    std::span<const std::uint32_t> fragment_code;
    std::uint32_t images;
    std::uint32_t parameter_bytes;
    std::vector<VkFormat> target_formats;
  };
  // The Gpu must outlive the pass.
  [[nodiscard]] static Result<std::unique_ptr<FullScreenPass>> create(Gpu& gpu,
                                                                      Description description);
  ~FullScreenPass();

  // Adds the pass, at most kCallsPerFrame times in a frame. `targets` become their versions after
  // the pass. A null image, which the shader must not read, is replaced by the first image.
  template <typename Parameters>
  void add(framegraph::Graph& graph, std::span<const framegraph::Texture> images,
           std::span<framegraph::Texture> targets, const Parameters& parameters) {
    const auto bytes = std::as_bytes(std::span(&parameters, 1));
    add(graph, images, targets, std::vector(bytes.begin(), bytes.end()));
  }
  static constexpr std::uint32_t kCallsPerFrame = 8;

 private:
  FullScreenPass(Gpu& gpu, Description description)
      : gpu_(gpu), description_(std::move(description)), layout_(gpu.device().device()) {}
  VkResult create_pipeline();
  void add(framegraph::Graph& graph, std::span<const framegraph::Texture> images,
           std::span<framegraph::Texture> targets, std::vector<std::byte> parameters);

  Gpu& gpu_;
  Description description_;
  VkSampler sampler_ = VK_NULL_HANDLE;  // linear; wraps around in u
  PipelineLayout layout_;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  std::uint32_t next_set_ = 0;
};

}  // namespace alcove::sample
