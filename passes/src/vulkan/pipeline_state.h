// The inside of Pipelines: the Vulkan objects of each shader, and the recording of dispatches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "alcove/passes/pipelines.h"
#include "vulkan/descriptor_sets.h"
#include "vulkan/host_buffer.h"
#include "work/shader_table.h"

namespace alcove::passes {

// A pipeline of Pipelines: valid as long as they are.
struct Pipeline {
  VkPipeline pipeline = VK_NULL_HANDLE;
  Shader shader = Shader::count;
};

// The Vulkan objects of one shader. The module and the table are created with its first pipeline.
struct ShaderObjects {
  VkShaderModule module = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout pipeline_layout = VK_NULL_HANDLE;
  std::unique_ptr<HostBuffer> table;  // null if the shader has none
};

// A pipeline with the constants that it was created with.
struct CachedPipeline {
  Shader shader = Shader::count;
  std::vector<AlcoveWorkConstant> constants;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

struct Pipelines::State {
  framegraph::VulkanFunctions vk;
  framegraph::DeviceHandles handles;
  VkPipelineCache cache = VK_NULL_HANDLE;  // the caller's
  VkSampler sampler = VK_NULL_HANDLE;      // of all shaders: nearest, clamped to the edge
  std::array<ShaderObjects, kShaderCount> shaders;
  std::vector<CachedPipeline> cached;
  std::unique_ptr<DescriptorSets> sets;
  AlcoveWork scratch;  // of the work that is being described, which is too large for a stack

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();

  // Returns the pipeline of `shader` with the values of AlcoveWorkDispatch::constants. Errors: a
  // pipeline that the device could not create.
  [[nodiscard]] tl::expected<Pipeline, Error> get(
      Shader shader, std::span<const AlcoveWorkConstant> constants = {});

  // Records a dispatch of `groups`. `parameters` are the contents of the shader's uniform buffer.
  // `views` has one view for each image binding of the shader, ascending by number: sampled images
  // in the layout SHADER_READ_ONLY_OPTIMAL, storage images in GENERAL.
  void dispatch(framegraph::RecordContext& context, Pipeline pipeline,
                std::span<const VkImageView> views, std::span<const std::byte> parameters,
                const std::array<std::uint32_t, 3>& groups) const;

  [[nodiscard]] std::size_t table_bytes() const;

  // The steps of Pipelines::create() and of get().
  tl::expected<void, Error> check_limits() const;
  tl::expected<void, Error> create_sampler();
  tl::expected<void, Error> create_layouts();
  tl::expected<void, Error> create_sets(std::uint32_t slot_count);

 private:
  VkDevice device() const { return handles.device; }
  const VkAllocationCallbacks* callbacks() const { return handles.host.allocation_callbacks; }
  tl::expected<void, Error> create_layout(std::size_t shader);
  tl::expected<void, Error> create_module(std::size_t shader);
  tl::expected<void, Error> create_table(std::size_t shader);
  tl::expected<Pipeline, Error> create_pipeline(Shader shader,
                                                std::span<const AlcoveWorkConstant> constants);
};

}  // namespace alcove::passes
