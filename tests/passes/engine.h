// A small engine for tests of the C interface. It owns images and command buffers.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "alcove/alcove.h"
#include "gpu/gpu_image.h"
#include "gpu/vulkan_device.h"

namespace alcove::passes {

class TestEngine {
 public:
  static constexpr std::uint32_t kSlots = 2;

  explicit TestEngine(const sample::VulkanDevice& device);
  ~TestEngine();
  TestEngine(const TestEngine&) = delete;
  TestEngine& operator=(const TestEngine&) = delete;

  AlcoveContextInfo context_info() const;

  // Creates an image in the state kResting with undefined contents.
  AlcoveImage make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                         VkImageUsageFlags usage, std::uint32_t layers = 1,
                         VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT);

  // Destroys an image that make_image() returned. The device must have finished using it.
  void destroy_image(const AlcoveImage& image);

  // Calls alcoveForgetImage for every image.
  void forget_images(AlcoveContext& context) const;

  // Waits for the previous frame of `slot`, calls `record` with the command buffer of the slot, and
  // submits it even if `record` fails. Does not wait for the new frame.
  void submit(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& record);
  void wait();

 private:
  struct Slot {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };
  const sample::VulkanDevice& device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::array<Slot, kSlots> slots_;
  std::vector<std::unique_ptr<sample::GpuImage>> images_;
};

AlcoveSettings get_settings(AlcoveQuality quality, float radius);

// Resets a command buffer and begins it again, so that nothing that was recorded is submitted.
void throw_away(VkCommandBuffer commands);

// The state of an engine's images between frames: fragment shaders sample them.
inline constexpr AlcoveState kResting{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

struct DestroyContext {
  void operator()(AlcoveContext* context) const { alcoveDestroyContext(context); }
};
using Context = std::unique_ptr<AlcoveContext, DestroyContext>;

}  // namespace alcove::passes
