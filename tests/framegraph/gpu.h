// A device under the validation layers, and enough of a command buffer to run frames on it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alcove/framegraph/framegraph.h"
#include "alcove/framegraph/verify.h"
#include "gpu/gpu.h"
#include "gpu/gpu_image.h"
#include "gpu/vulkan_device.h"

namespace alcove::framegraph {

// A host-visible buffer that passes copy results into. Gpu owns it.
struct HostBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  const std::uint32_t* words = nullptr;
};

// Records a clear of an image with one 32-bit channel.
inline void clear_image(RecordContext& context, VkImage image, std::uint32_t value,
                        const VkImageSubresourceRange& range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                                                                1}) {
  VkClearColorValue color{};
  color.uint32[0] = value;
  vkCmdClearColorImage(context.commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1,
                       &range);
}

// Records a copy of the first texels of an image to a buffer, from `offset` on.
inline void copy_image(RecordContext& context, VkImage image, VkBuffer buffer,
                       VkDeviceSize offset = 0, VkExtent3D extent = {1, 1, 1},
                       const VkImageSubresourceLayers& layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0,
                                                                 1}) {
  const VkBufferImageCopy copy{offset, 0, 0, layers, {}, extent};
  vkCmdCopyImageToBuffer(context.commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1,
                         &copy);
}

// Records a barrier between two commands of a pass that have this access.
inline void order(RecordContext& context, const Access& access) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = barrier.dstStageMask = access.stages;
  barrier.srcAccessMask = access.access & kWriteBits;
  barrier.dstAccessMask = access.access;
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = 1,
                              .pMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(context.commands, &info);
}

// Adds a pass that clears a texture with one 32-bit channel. Returns the cleared texture.
inline Texture add_clear(Graph& graph, Texture texture, std::uint32_t value,
                         Contents contents = Contents::discard,
                         QueueClass queue = QueueClass::graphics) {
  PassBuilder pass = graph.add_pass("clear", queue);
  texture = pass.write(texture, access::clear, {}, contents);
  pass.record([=](RecordContext& c) { clear_image(c, c.image(texture), value); });
  return texture;
}

// Adds a pass that copies the first texel of a texture to a buffer. Returns the written buffer.
inline Buffer add_copy(Graph& graph, Texture texture, Buffer out, VkDeviceSize offset = 0) {
  PassBuilder pass = graph.add_pass("copy");
  pass.read(texture, access::transfer_source);
  out = pass.write(out, buffer_access::transfer_destination,
                   out.version == 0 ? Contents::discard : Contents::keep);
  pass.record([=](RecordContext& c) { copy_image(c, c.image(texture), c.buffer(out), offset); });
  return out;
}

class Gpu {
 public:
  static constexpr std::uint32_t kSlots = 4;  // frame slots, each with a command buffer

  // Without validation it serves tests that count calls of the executor.
  explicit Gpu(bool validation = true) {
    sample::DeviceOptions options;
    options.validation = validation_ = validation;
    auto made = sample::VulkanDevice::create(options);
    if (!made) {
      problem_ = made.error();
      return;
    }
    device_ = std::move(*made);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                 VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                 device_->queue_family()};
    vkCreateCommandPool(device_->device(), &pool, nullptr, &pool_);
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                     VK_COMMAND_BUFFER_LEVEL_PRIMARY, kSlots};
    vkAllocateCommandBuffers(device_->device(), &info, commands_);
  }
  ~Gpu() {
    if (!device_) return;
    vkDeviceWaitIdle(device_->device());
    buffers_.clear();
    images_.clear();
    vkDestroyCommandPool(device_->device(), pool_, nullptr);
  }

  const std::string& problem() const { return problem_; }
  sample::VulkanDevice& device() { return *device_; }
  DeviceHandles handles() const {
    DeviceHandles handles;
    handles.instance = device_->instance();
    handles.physical_device = device_->physical_device();
    handles.device = device_->device();
    handles.get_instance_proc_addr = vkGetInstanceProcAddr;
    handles.queues[0] = {device_->queue(), device_->queue_family()};
    handles.debug_utils = validation_;
    return handles;
  }

  HostBuffer make_host_buffer(VkDeviceSize size) {
    auto made = sample::HostBuffer::create(
        *device_, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    EXPECT_TRUE(made) << made.error();
    const std::span<std::byte> bytes = (*made)->bytes();
    std::fill(bytes.begin(), bytes.end(), std::byte{});
    buffers_.push_back(std::move(*made));
    return {buffers_.back()->buffer(), size, reinterpret_cast<const std::uint32_t*>(bytes.data())};
  }
  VkImage make_image(const TextureDesc& desc, VkImageUsageFlags usage) {
    auto made = sample::GpuImage::create(*device_, desc, usage);
    EXPECT_TRUE(made) << made.error();
    images_.push_back(std::move(*made));
    return images_.back()->image();
  }
  // Changes the layout of an image from UNDEFINED in a submission of its own.
  void change_layout(VkImage image, VkImageLayout layout) {
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT,
        .newLayout = layout,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                             VK_REMAINING_ARRAY_LAYERS}};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .imageMemoryBarrierCount = 1,
                                .pImageMemoryBarriers = &barrier};
    begin();
    vkCmdPipelineBarrier2(commands(), &info);
    end();
    submit_and_wait();
  }

  static ImportedBuffer imported(const HostBuffer& host) {
    ImportedBuffer import;
    import.buffer = host.buffer;
    import.desc.size = host.size;
    import.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    import.has_contents = false;
    import.final_state = buffer_access::host_read;
    return import;
  }

  // Records one frame, runs it and waits for it. On an error, the commands are discarded.
  tl::expected<FrameReport, Errors> run(Executor& executor, Graph& graph) {
    auto report = record(executor, graph);
    if (report) submit_and_wait();
    return report;
  }
  // Records one frame with the commands of a slot, and does not submit them.
  tl::expected<FrameReport, Errors> record(Executor& executor, Graph& graph,
                                           std::uint32_t slot = 0) {
    begin(slot);
    auto report = executor.record(graph, commands_[slot], {slot});
    end(slot);
    return report;
  }

  VkCommandBuffer commands() const { return commands_[0]; }
  void begin(std::uint32_t slot = 0) {
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                  VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    vkBeginCommandBuffer(commands_[slot], &info);
  }
  void end(std::uint32_t slot = 0) { vkEndCommandBuffer(commands_[slot]); }
  void submit(std::uint32_t slot = 0) {
    const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                            .commandBufferCount = 1,
                            .pCommandBuffers = &commands_[slot]};
    vkQueueSubmit(device_->queue(), 1, &info, VK_NULL_HANDLE);
  }
  void submit_and_wait() {
    submit();
    vkQueueWaitIdle(device_->queue());
  }

  // Returns the messages of the validation layers, one per line, without those that contain one of
  // the texts in `except`.
  std::string messages(std::initializer_list<const char*> except = {}) const {
    std::string text;
    for (const std::string& message : device_->validation_messages()) {
      const bool excepted = std::any_of(except.begin(), except.end(), [&](const char* part) {
        return message.find(part) != std::string::npos;
      });
      if (!excepted) text += message + '\n';
    }
    return text;
  }

 private:
  std::unique_ptr<sample::VulkanDevice> device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_[kSlots] = {};
  std::vector<std::unique_ptr<sample::GpuImage>> images_;
  std::vector<std::unique_ptr<sample::HostBuffer>> buffers_;
  std::string problem_;
  bool validation_ = true;
};

}  // namespace alcove::framegraph
