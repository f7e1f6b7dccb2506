// A small engine for tests of the C interface: images, command buffers, frames in flight, and
// copies between images and the host. Needs no more than Vulkan 1.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alcove/alcove.h"
#include "gpu/gpu.h"

namespace alcove::passes {

using Bytes = std::vector<std::byte>;

// The state of an engine's images between frames: fragment shaders sample them.
inline constexpr AlcoveState kResting{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

// Returns what a graph imports an image as.
framegraph::ImportedTexture import_of(const AlcoveImage& image);

class TestEngine {
 public:
  static constexpr std::uint32_t kSlots = 2;

  // `device` must outlive the engine.
  explicit TestEngine(const sample::VulkanDevice& device);
  ~TestEngine();
  TestEngine(const TestEngine&) = delete;
  TestEngine& operator=(const TestEngine&) = delete;

  const sample::VulkanDevice& device() const { return device_; }
  AlcoveContextInfo context_info() const;

  // Creates an image in the state kResting with undefined contents.
  AlcoveImage make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                         VkImageUsageFlags usage, std::uint32_t layers = 1,
                         VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT);
  // Creates a view with images of these roles, in formats with 8 bits where they suffice.
  AlcoveView make_view(const AlcoveSettings& settings, std::uint32_t width, std::uint32_t height,
                       std::initializer_list<AlcoveImageRole> roles);

  // Creates an image that shaders sample, with tightly packed texels.
  AlcoveImage make_filled(VkFormat format, std::uint32_t width, std::uint32_t height,
                          std::span<const std::byte> texels, VkImageUsageFlags further_usage = 0);

  // Destroys an image that was created here. The device must have finished using it.
  void destroy_image(const AlcoveImage& image);

  // Calls alcoveForgetImage for every image.
  void forget_images(AlcoveContext& context) const;

  // Fills an image, which is in the state kResting, with tightly packed texels, and leaves it in
  // `final_state`. Waits for the device.
  void write(const AlcoveImage& image, std::span<const std::byte> texels,
             const AlcoveState& final_state = kResting);
  // Returns the texels of an image, which is in its final state. Waits for the device.
  Bytes read(const AlcoveImage& image);

  // Waits for the previous frame of `slot`, and calls `record` with the command buffer of the slot.
  void record(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& record);
  // Submits what was recorded last in `slot`, and does not wait for it.
  void submit(std::uint32_t slot);
  // Records and submits, even if `record` fails.
  void submit(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& record);
  void wait();

  std::unique_ptr<sample::HostBuffer> create_buffer(VkBufferUsageFlags usage,
                                                    VkDeviceSize size) const;

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

struct DestroyContext {
  void operator()(AlcoveContext* context) const { alcoveDestroyContext(context); }
};
using Context = std::unique_ptr<AlcoveContext, DestroyContext>;
Context create_context(const AlcoveContextInfo& info);

// Functions that contexts with get_replaced_function() get instead of the loader's, by name. Null
// stands for a function that is missing.
inline std::map<std::string, PFN_vkVoidFunction, std::less<>> replaced_functions;
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_replaced_function(VkInstance instance,
                                                               const char* name);
template <typename Function>
PFN_vkVoidFunction untyped(Function* function) {
  return reinterpret_cast<PFN_vkVoidFunction>(function);
}

}  // namespace alcove::passes
