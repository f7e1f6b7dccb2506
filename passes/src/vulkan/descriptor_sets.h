// The descriptor sets of the passes' dispatches, and the uniform buffer with their parameters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/record_context.h"
#include "alcove/passes/pipelines.h"
#include "vulkan/host_buffer.h"
#include "work/shader_table.h"

namespace alcove::passes {

inline constexpr std::size_t kMaxBindings = ALCOVE_MAX_WORK_BINDINGS;

// One dispatch: its shader, and the objects that its descriptor set points to.
struct DispatchBindings {
  Shader shader = Shader::count;
  const ShaderInterface* interface = nullptr;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkBuffer table = VK_NULL_HANDLE;  // null if the shader has no storage buffer
  // One view for each image binding of the shader, ascending by binding number.
  std::span<const VkImageView> views;
  std::span<const std::byte> parameters;
};

// Keeps descriptor sets for each frame slot and each dispatch of a frame. A frame that repeats an
// earlier one finds the sets of that frame, and neither allocates nor writes any.
class DescriptorSets {
 public:
  // Creates the object. The descriptor pools are sized for the interfaces of all shaders. `vk` and
  // `device` must outlive the result.
  static tl::expected<std::unique_ptr<DescriptorSets>, Error> create(
      const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device,
      std::uint32_t slot_count);
  DescriptorSets(const DescriptorSets&) = delete;
  DescriptorSets& operator=(const DescriptorSets&) = delete;
  ~DescriptorSets();

  // Starts a frame in `slot`, whose previous frame must have finished on the device.
  void begin_frame(std::uint32_t slot);

  // Copies the parameters to the uniform buffer and returns a descriptor set with all resources of
  // `bound`. If the frame slot does not exist, the frame already has Pipelines::kMaxDispatches, or
  // memory runs out, calls context.fail() and returns null.
  [[nodiscard]] VkDescriptorSet get(framegraph::RecordContext& context,
                                    const DispatchBindings& bound);

  // Device memory of the parameters, in bytes.
  [[nodiscard]] VkDeviceSize parameter_bytes() const;

 private:
  // A descriptor set, and what was written to it last.
  struct Set {
    Shader shader = Shader::count;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::uint64_t handle_epoch = 0;  // RecordContext::handle_epoch at that time
    VkDeviceSize parameter_bytes = 0;
    std::size_t view_count = 0;
    std::array<VkImageView, kMaxBindings> views{};
  };

  // The descriptor sets of one dispatch in one frame slot. There are two, because a history
  // alternates between two images: with an odd number of frames in flight, a slot uses both of them
  // in turn.
  struct DispatchSets {
    std::array<Set, 2> sets;
    std::size_t latest = 0;
  };

  struct FrameSlot {
    VkDescriptorPool pool = VK_NULL_HANDLE;
    std::array<DispatchSets, Pipelines::kMaxDispatches> dispatches;
  };

  // A dispatch of the frame, counted from 0, and its descriptor set.
  struct Claim {
    std::uint32_t number = 0;
    VkDescriptorSet set = VK_NULL_HANDLE;  // null after an error
    bool is_written = false;               // the set already holds what the dispatch binds
  };

  DescriptorSets(const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device)
      : vk_(vk), device_(device) {}
  static bool holds(const Set& set, const DispatchBindings& bound,
                    const framegraph::RecordContext& context);
  VkResult create_pools(std::uint32_t slot_count);
  VkResult allocate(Set& set, const DispatchBindings& bound);
  Claim claim(framegraph::RecordContext& context, const DispatchBindings& bound);
  void write(VkDescriptorSet set, const DispatchBindings& bound, VkDeviceSize offset);

  const framegraph::VulkanFunctions& vk_;
  const framegraph::DeviceHandles& device_;
  std::vector<FrameSlot> slots_;
  std::unique_ptr<HostBuffer> parameters_;
  std::size_t slot_ = 0;
  std::uint32_t dispatches_ = 0;  // of this frame so far
};

}  // namespace alcove::passes
