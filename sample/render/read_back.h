#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "support/glm.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Texels as floats; channels that the format does not have are 0.
using Texels = Image<glm::vec4>;

// Textures of one frame that are copied to the host. The object must outlive the frame.
class ReadBack {
 public:
  // `border` pixels at each side of every texture are left out.
  explicit ReadBack(const VulkanDevice& device, VkExtent2D border = {})
      : device_(device), border_(border) {}

  // Adds a pass that copies mip 0 of `texture` to the host, and makes it an output of the frame.
  // Adds nothing if `texture` is null. finish() calls `store` with the texels.
  void add(framegraph::Graph& graph, framegraph::Texture texture,
           std::function<void(const Texels&)> store);
  // Returns the first error of add().
  [[nodiscard]] const Result<void>& added() const { return added_; }
  // Converts the texels. The device must have finished the frame.
  void finish() const;

 private:
  struct Copy {
    std::unique_ptr<HostBuffer> buffer;
    VkFormat format;
    VkExtent3D size;
    std::function<void(const Texels&)> store;
  };
  const VulkanDevice& device_;
  VkExtent2D border_;
  std::vector<Copy> copies_;
  Result<void> added_;
};

// Returns one channel of an image, or its first three channels.
[[nodiscard]] Image<float> channel(const Texels& texels, int index);
[[nodiscard]] Image<glm::vec3> rgb(const Texels& texels);

}  // namespace alcove::sample
