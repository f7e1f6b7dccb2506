// Graphics pipelines, the descriptor sets that they read, and renderings that they draw to.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

#include "alcove/framegraph/record_context.h"

namespace alcove::sample {

// A descriptor of a set layout. Its binding number is its position in the set.
struct Descriptor {
  VkDescriptorType type;
  VkShaderStageFlags stages;
  std::uint32_t count = 1;
};

// A descriptor set layout, and the number of sets to allocate with it.
struct SetDescription {
  std::vector<Descriptor> descriptors;
  std::uint32_t count;
};

// A pipeline layout and all descriptor sets for it.
class PipelineLayout {
 public:
  explicit PipelineLayout(VkDevice device) : device_(device) {}
  ~PipelineLayout();
  PipelineLayout(const PipelineLayout&) = delete;
  PipelineLayout& operator=(const PipelineLayout&) = delete;

  // Creates layout and sets. To be called once.
  [[nodiscard]] VkResult create(std::span<const SetDescription> sets,
                                const VkPushConstantRange& push_constants);
  [[nodiscard]] VkPipelineLayout handle() const { return layout_; }
  // Returns a set with the set number `number`.
  [[nodiscard]] VkDescriptorSet set(std::uint32_t number, std::size_t index) const {
    return sets_[number][index];
  }
  // Writes one binding of a set, which no frame in flight may be reading: images, or one buffer.
  void write(VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
             std::span<const VkDescriptorImageInfo> images,
             const VkDescriptorBufferInfo* buffer = nullptr) const;
  // Binds a set; `offsets` has one number for each dynamic buffer of the set.
  void bind(VkCommandBuffer commands, std::uint32_t number, VkDescriptorSet set,
            std::span<const std::uint32_t> offsets = {}) const;

 private:
  VkResult allocate(std::span<const SetDescription> sets);

  VkDevice device_;
  std::vector<VkDescriptorSetLayout> set_layouts_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<std::vector<VkDescriptorSet>> sets_;  // by set number
};

// A pipeline that draws triangles without blending or multisampling. Viewport and scissor are
// dynamic.
struct PipelineDescription {
  std::span<const std::uint32_t> vertex_code;
  std::span<const std::uint32_t> fragment_code;
  const VkSpecializationInfo* fragment_constants = nullptr;
  std::span<const VkVertexInputBindingDescription> streams;
  std::span<const VkVertexInputAttributeDescription> attributes;
  std::span<const VkFormat> colour_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;  // undefined: no depth test
  VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
  std::vector<VkDynamicState> dynamic_states;  // besides viewport and scissor
  VkPipelineLayout layout;
};
[[nodiscard]] VkResult create_pipeline(VkDevice device, PipelineDescription description,
                                       VkPipeline& pipeline);

// Begins a rendering over the whole of the attachments, and sets viewport and scissor to it.
// `depth` may be null.
void begin_rendering(const framegraph::RecordContext& context,
                     std::span<const framegraph::Attachment> colours,
                     const framegraph::Attachment& depth = {});

}  // namespace alcove::sample
