#include "gpu/gpu.h"

#include <glm/gtc/packing.hpp>
#include <utility>

#include "gpu/gpu_image.h"

#include "gpu/pipeline_capture.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

framegraph::DeviceHandles handles_of(const VulkanDevice& device) {
  framegraph::DeviceHandles handles;
  handles.instance = device.instance();
  handles.physical_device = device.physical_device();
  handles.device = device.device();
  handles.get_instance_proc_addr =
      device.captures() ? capturing_functions() : vkGetInstanceProcAddr;
  handles.queues[static_cast<std::size_t>(framegraph::QueueClass::graphics)] = {
      device.queue(), device.queue_family()};
  return handles;
}

}  // namespace

tl::expected<std::unique_ptr<HostBuffer>, std::string> HostBuffer::create(
    const VulkanDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage) {
  if (bytes > device.max_allocation()) {
    return too_large("a buffer", bytes, device);
  }
  std::unique_ptr<HostBuffer> made(new HostBuffer(device));
  made->size_ = bytes;
  made->usage_ = usage;
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
  VkResult result = vkCreateBuffer(device.device(), &info, nullptr, &made->buffer_);
  VkMemoryRequirements needs{};
  if (result == VK_SUCCESS) {
    vkGetBufferMemoryRequirements(device.device(), made->buffer_, &needs);
    const VkMemoryAllocateInfo allocation{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex =
            device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                         VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)};
    result = vkAllocateMemory(device.device(), &allocation, nullptr, &made->memory_);
  }
  void* mapped = nullptr;
  if (result == VK_SUCCESS) {
    result = vkBindBufferMemory(device.device(), made->buffer_, made->memory_, 0);
  }
  if (result == VK_SUCCESS) {
    result = vkMapMemory(device.device(), made->memory_, 0, VK_WHOLE_SIZE, 0, &mapped);
  }
  if (result != VK_SUCCESS) {
    return device_failure("give a buffer of " + std::to_string(bytes) + " bytes", result);
  }
  made->mapped_ = static_cast<std::byte*>(mapped);
  return made;
}

HostBuffer::~HostBuffer() {
  vkDestroyBuffer(device_.device(), buffer_, nullptr);
  vkFreeMemory(device_.device(), memory_, nullptr);
}

framegraph::ImportedBuffer HostBuffer::import() const {
  framegraph::ImportedBuffer import;
  import.buffer = buffer_;
  import.desc.size = size_;
  import.usage = usage_;
  import.has_contents = true;
  import.final_state = framegraph::buffer_access::host_read;
  return import;
}

tl::expected<std::unique_ptr<Gpu>, std::string> Gpu::create(
    const DeviceOptions& options, const framegraph::ExecutorOptions& executor_options) {
  auto device = VulkanDevice::create(options);
  if (!device) {
    return Failure(std::move(device.error()));
  }
  std::unique_ptr<Gpu> made(new Gpu);
  made->device_ = std::move(*device);
  made->frames_in_flight_ = executor_options.frames_in_flight;
  if (const VkResult result = made->create_commands(); result != VK_SUCCESS) {
    return device_failure("create a command buffer", result);
  }
  framegraph::DeviceHandles handles = handles_of(*made->device_);
  handles.debug_utils = options.validation;
  auto executor = framegraph::Executor::create(handles, executor_options);
  if (!executor) {
    return Failure(framegraph::to_string(executor.error()));
  }
  made->executor_ = std::make_unique<framegraph::Executor>(std::move(*executor));
  auto kernels = passes::Kernels::create(handles, executor_options.frames_in_flight);
  if (!kernels) {
    return Failure(std::move(kernels.error().message));
  }
  made->kernels_ = std::make_unique<passes::Kernels>(std::move(*kernels));
  return made;
}

Gpu::~Gpu() {
  if (device_) {
    vkDeviceWaitIdle(device_->device());
    vkDestroyFence(device_->device(), fence_, nullptr);
    vkDestroyCommandPool(device_->device(), pool_, nullptr);
  }
}

tl::expected<framegraph::FrameReport, std::string> Gpu::record(const Declare& declare,
                                                               VkCommandBuffer commands,
                                                               std::uint32_t slot) {
  graph_.reset();
  kernels_->begin_frame(slot);
  if (auto declared = declare(graph_); !declared) {
    return Failure(std::move(declared.error()));
  }
  auto report = executor_->record(graph_, commands, {slot});
  if (!report) {
    return Failure(framegraph::to_string(report.error()));
  }
  return *report;
}

tl::expected<framegraph::FrameReport, std::string> Gpu::run(const Declare& declare) {
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  VkResult result = vkBeginCommandBuffer(commands_, &begin);
  if (result != VK_SUCCESS) {
    return device_failure("begin a frame's commands", result);
  }
  auto report = record(declare, commands_, 0);
  result = vkEndCommandBuffer(commands_);
  if (!report) {
    return report;
  }
  if (result == VK_SUCCESS) {
    result = submit_and_wait();
  }
  if (result != VK_SUCCESS) {
    return device_failure("run a frame", result);
  }
  return report;
}

VkResult Gpu::submit_and_wait() {
  const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                            .commandBufferCount = 1,
                            .pCommandBuffers = &commands_};
  const VkDevice device = device_->device();
  VkResult result = vkQueueSubmit(device_->queue(), 1, &submit, fence_);
  if (result == VK_SUCCESS) {
    result = vkWaitForFences(device, 1, &fence_, VK_TRUE, UINT64_MAX);
  }
  return result == VK_SUCCESS ? vkResetFences(device, 1, &fence_) : result;
}

VkResult Gpu::create_commands() {
  const VkDevice device = device_->device();
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = device_->queue_family()};
  VkResult result = vkCreateCommandPool(device, &pool, nullptr, &pool_);
  if (result == VK_SUCCESS) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    result = vkAllocateCommandBuffers(device, &info, &commands_);
  }
  if (result == VK_SUCCESS) {
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    result = vkCreateFence(device, &fence, nullptr, &fence_);
  }
  return result;
}

Texture add_copy(Graph& graph, const HostBuffer& source, Texture target) {
  const framegraph::Buffer from = graph.import_buffer("upload", source.import());
  auto pass = graph.add_pass("upload");
  pass.read(from, framegraph::buffer_access::transfer_source);
  const Texture filled = pass.write(target, framegraph::access::transfer_destination,
                                    framegraph::Range::mip(0), framegraph::Contents::discard);
  pass.record([from, filled](RecordContext& context) {
    const VkBufferImageCopy copy{.imageSubresource = {aspect_of(context.format(filled)), 0, 0, 1},
                                 .imageExtent = context.extent(filled)};
    vkCmdCopyBufferToImage(context.commands, context.buffer(from), context.image(filled),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  });
  return filled;
}

Texture add_mips(Graph& graph, Texture texture, std::uint32_t mips) {
  for (std::uint32_t mip = 1; mip < mips; ++mip) {
    auto pass = graph.add_pass("mip");
    pass.read(texture, framegraph::access::blit_source, framegraph::Range::mip(mip - 1));
    texture = pass.write(texture, framegraph::access::blit_destination, framegraph::Range::mip(mip),
                         framegraph::Contents::discard);
    pass.record([texture, mip](RecordContext& context) {
      const auto corner = [&](std::uint32_t of) {
        const VkExtent3D size = context.extent(texture, of);
        return VkOffset3D{static_cast<int32_t>(size.width), static_cast<int32_t>(size.height), 1};
      };
      const VkImageBlit2 region{.sType = VK_STRUCTURE_TYPE_IMAGE_BLIT_2,
                                .srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1},
                                .srcOffsets = {{}, corner(mip - 1)},
                                .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1},
                                .dstOffsets = {{}, corner(mip)}};
      const VkImage image = context.image(texture);
      const VkBlitImageInfo2 blit{.sType = VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2,
                                  .srcImage = image,
                                  .srcImageLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                  .dstImage = image,
                                  .dstImageLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                  .regionCount = 1,
                                  .pRegions = &region,
                                  .filter = VK_FILTER_LINEAR};
      vkCmdBlitImage2(context.commands, &blit);
    });
  }
  return texture;
}

void add_read_back(Graph& graph, Texture texture, const HostBuffer& target, std::uint32_t mip) {
  const framegraph::Buffer buffer = graph.import_buffer("read back", target.import());
  auto pass = graph.add_pass("read back");
  pass.read(texture, framegraph::access::transfer_source, framegraph::Range::mip(mip));
  const framegraph::Buffer filled =
      pass.write(buffer, framegraph::buffer_access::transfer_destination);
  pass.record([texture, filled, mip](RecordContext& context) {
    const VkBufferImageCopy copy{
        .imageSubresource = {aspect_of(context.format(texture)), mip, 0, 1},
        .imageExtent = context.extent(texture, mip)};
    vkCmdCopyImageToBuffer(context.commands, context.image(texture),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.buffer(filled), 1, &copy);
  });
}

float half_to_float(std::uint16_t half) { return glm::unpackHalf1x16(half); }

}  // namespace alcove::sample
