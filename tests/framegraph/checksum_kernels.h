// The two compute kernels with which device tests mix contents, and their descriptor sets.
#pragma once

#include "alcove/framegraph/framegraph.h"
#include "gpu.h"

namespace alcove::framegraph {

// Mixes two words in the same way as the kernels. The model that computes the expected contents on
// the CPU uses it.
inline std::uint32_t mix_in(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t x = (a ^ b) * 0x9e3779b1u;
  return x ^ (x >> 15);
}

class ChecksumKernels {
 public:
  explicit ChecksumKernels(Gpu& gpu);
  ~ChecksumKernels();
  ChecksumKernels(const ChecksumKernels&) = delete;
  ChecksumKernels& operator=(const ChecksumKernels&) = delete;

  // Frees all descriptor sets: the device must be idle.
  void reset();
  void mix_texture(RecordContext& context, VkImageView sampled, VkImageView storage,
                   VkImageView result, VkExtent3D size, std::uint32_t seed, bool keep);
  void mix_buffer(RecordContext& context, VkImageView sampled, VkBuffer from, VkBuffer to,
                  std::uint32_t words, std::uint32_t seed, bool keep);

 private:
  // The bindings of a kernel: a sampled image, then two storage images or buffers.
  static constexpr std::uint32_t kBindings = 3;
  struct Kernel {
    VkDescriptorType written = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
  };
  // The resource of a binding: an image or a buffer.
  struct Resource {
    VkDescriptorImageInfo image{};
    VkDescriptorBufferInfo buffer{};
  };
  Kernel make(const std::uint32_t* code, std::size_t size, VkDescriptorType written);
  void destroy(Kernel& kernel);
  void run(RecordContext& context, const Kernel& kernel, const Resource* resources,
           VkExtent2D groups, std::uint32_t seed, bool keep);

  VkDevice device_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  Kernel texture_;
  Kernel buffer_;
};

}  // namespace alcove::framegraph
