#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"

namespace alcove::passes {

// A float image of the host, row by row from the top.
struct HostImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> texels;  // `channels` a pixel
  std::uint32_t channels = 1;

  float at(std::uint32_t x, std::uint32_t y, std::uint32_t channel = 0) const {
    return texels[(std::size_t{y} * width + x) * channels + channel];
  }
};

// Runs passes on the machine's device under the validation layers; a message of theirs fails the
// test.
class PassTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // Adds a texture of 32-bit floats (1, 2 or 4 channels) that holds `image`.
  // A `format` of 32-bit channels takes the floats by their bits.
  framegraph::Texture upload(framegraph::Graph& graph, const HostImage& image,
                             VkFormat format = VK_FORMAT_UNDEFINED);
  // Has `target`, of such a format, filled with `image`.
  framegraph::Texture fill(framegraph::Graph& graph, framegraph::Texture target,
                           const HostImage& image);
  // Has `texture`, of any format that the passes write, read back: result() gives it as floats once
  // the frame has run.
  void read_back(framegraph::Graph& graph, framegraph::Texture texture, std::uint32_t mip = 0);
  // The images read back by the last frame, in order.
  const HostImage& result(std::size_t index = 0) const { return results_[index]; }

  // Runs one frame that `declare` declares; fails the test where it cannot.
  void run(const std::function<void(framegraph::Graph&)>& declare);

  // Runs frame `frame.index` of the whole of add_occlusion and returns its images.
  struct OcclusionFrame {
    View view;
    const HostImage& depth_ndc;
    const HostImage* normal_vs = nullptr;  // null: from depth
    const HostImage* motion = nullptr;     // null: none
    View previous_view = view;
    std::uint32_t index = 0;
    bool reset = false;                         // forgets the history first
    const HostImage* back_depth_ndc = nullptr;  // null: none
    const HostImage* second_depth_ndc = nullptr;
    const HostImage* roughness = nullptr;
    VkExtent2D previous_size{};  // as Frame has them
    VkExtent2D largest_size{};
  };
  struct OcclusionImages {
    HostImage visibility;
    HostImage bent_normal;  // empty where none was asked for, as is the next
    HostImage specular;
  };
  OcclusionImages run_occlusion(const OcclusionFrame& frame, const OcclusionSettings& settings);

  // Fills the device memory that transients of about this size get with what is not a number, so
  // that a texel which a pass forgets shows.
  void poison_memory(std::uint32_t width, std::uint32_t height);

  sample::Gpu& gpu() { return *gpu_; }

 private:
  struct Download {
    std::unique_ptr<sample::HostBuffer> buffer;
    VkFormat format = VK_FORMAT_UNDEFINED;
  };
  std::unique_ptr<sample::Gpu> gpu_;
  std::vector<std::unique_ptr<sample::HostBuffer>> uploads_;
  std::vector<Download> downloads_;
  std::vector<HostImage> results_;
};

}  // namespace alcove::passes
