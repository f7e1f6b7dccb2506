#include "gpu/gpu.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <iterator>
#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

framegraph::DeviceHandles device_handles(const VulkanDevice& device) {
  framegraph::DeviceHandles handles;
  handles.instance = device.instance();
  handles.physical_device = device.physical_device();
  handles.device = device.device();
  handles.get_instance_proc_addr = vkGetInstanceProcAddr;
  handles.queues[static_cast<std::size_t>(framegraph::QueueClass::graphics)] = {
      device.queue(), device.queue_family()};
  return handles;
}

template <typename Number>
Number read(const std::byte* data) {
  Number value;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

// Fills all mips but mip 0 of a colour texture.
void add_mips(Graph& graph, Texture texture, std::uint32_t mips) {
  for (std::uint32_t mip = 1; mip < mips; ++mip) {
    auto pass = graph.add_pass("mip");
    pass.read(texture, framegraph::access::blit_source, framegraph::Range::mip(mip - 1));
    texture = pass.write(texture, framegraph::access::blit_destination, framegraph::Range::mip(mip),
                         framegraph::Contents::discard);
    pass.record([texture, mip](RecordContext& context) {
      const auto corner = [&](std::uint32_t of) {
        const VkExtent3D size = context.extent(texture, of);
        return VkOffset3D{static_cast<std::int32_t>(size.width),
                          static_cast<std::int32_t>(size.height), 1};
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
}

}  // namespace

tl::expected<std::unique_ptr<HostBuffer>, std::string> HostBuffer::create(
    const VulkanDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage) {
  if (bytes > device.max_allocation()) return too_large("a buffer", bytes, device);
  std::unique_ptr<HostBuffer> made(new HostBuffer(device));
  made->size_ = bytes;
  made->usage_ = usage;
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
  VkResult result = vkCreateBuffer(device.device(), &info, nullptr, &made->buffer_);
  if (result == VK_SUCCESS) {
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.device(), made->buffer_, &needs);
    result = device.allocate(
        needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
        made->memory_);
  }
  if (result == VK_SUCCESS)
    result = vkBindBufferMemory(device.device(), made->buffer_, made->memory_, 0);
  void* mapped = nullptr;
  if (result == VK_SUCCESS)
    result = vkMapMemory(device.device(), made->memory_, 0, VK_WHOLE_SIZE, 0, &mapped);
  if (result != VK_SUCCESS)
    return device_failure("give a buffer of " + std::to_string(bytes) + " bytes", result);
  made->mapped_ = static_cast<std::byte*>(mapped);
  return made;
}

HostBuffer::~HostBuffer() {
  vkDestroyBuffer(device_.device(), buffer_, nullptr);
  vkFreeMemory(device_.device(), memory_, nullptr);
}

framegraph::ImportedBuffer HostBuffer::import() const {
  return {.buffer = buffer_,
          .desc = {.size = size_},
          .usage = usage_,
          .final_state = framegraph::buffer_access::host_read};
}

tl::expected<std::unique_ptr<Gpu>, std::string> Gpu::create(
    const DeviceOptions& options, const framegraph::ExecutorOptions& executor_options) {
  std::unique_ptr<Gpu> made(new Gpu);
  made->executor_options_ = executor_options;
  auto device = VulkanDevice::create(options);
  if (!device) return Failure(std::move(device.error()));
  made->device_ = std::move(*device);
  made->handles_ = device_handles(*made->device_);
  made->handles_.debug_utils = options.validation;
  if (auto started = made->restart(); !started) return Failure(std::move(started.error()));
  auto pipelines = passes::Pipelines::create(made->handles_, executor_options.frames_in_flight);
  if (!pipelines) return Failure(std::move(pipelines.error().message));
  made->pipelines_.emplace(std::move(*pipelines));
  return made;
}

tl::expected<void, std::string> Gpu::restart() {
  vkDeviceWaitIdle(device_->device());
  auto executor = framegraph::Executor::create(handles_, executor_options_);
  if (!executor) return Failure(framegraph::to_string(executor.error()));
  executor_.emplace(std::move(*executor));
  return {};
}

Gpu::~Gpu() {
  if (device_) vkDeviceWaitIdle(device_->device());
}

tl::expected<void, std::string> Gpu::wait(std::uint32_t slot) {
  return executor_->wait(slot).map_error(
      [](const framegraph::Errors& errors) { return framegraph::to_string(errors); });
}

tl::expected<framegraph::FrameReport, std::string> Gpu::submit(const Declare& declare,
                                                               const framegraph::FrameInfo& frame) {
  if (auto waited = wait(frame.slot); !waited) return Failure(std::move(waited.error()));
  graph_.reset();
  pipelines_->begin_frame(frame.slot);
  if (auto declared = declare(graph_); !declared) return Failure(std::move(declared.error()));
  return executor_->submit(graph_, frame).map_error([](const framegraph::Errors& errors) {
    return framegraph::to_string(errors);
  });
}

tl::expected<framegraph::FrameReport, std::string> Gpu::run(const Declare& declare) {
  return submit(declare).and_then(
      [&](const framegraph::FrameReport& report) { return wait().map([&] { return report; }); });
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

tl::expected<std::unique_ptr<GpuImage>, std::string> upload_image(
    Gpu& gpu, VkFormat format, VkExtent2D size, std::span<const std::byte> texels) {
  const auto mips = static_cast<std::uint32_t>(std::bit_width(std::max(size.width, size.height)));
  auto image = GpuImage::create(
      gpu.device(), {format, framegraph::Extent::absolute(size.width, size.height), mips},
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
          VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  auto source = HostBuffer::create(gpu.device(), texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  if (!image) return image;
  if (!source) return Failure(std::move(source.error()));
  std::ranges::copy(texels, (*source)->bytes().begin());
  auto uploaded = gpu.run([&](Graph& graph) -> tl::expected<void, std::string> {
    const Texture target = graph.import_texture("image", (*image)->import_to_fill(kSampledState));
    add_mips(graph, add_copy(graph, **source, target), mips);
    return {};
  });
  if (!uploaded) return Failure(std::move(uploaded.error()));
  return image;
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

TexelLayout texel_layout(VkFormat format) {
  using Row = std::pair<VkFormat, TexelLayout>;
  constexpr Row kLayouts[] = {{VK_FORMAT_R8_UNORM, {1, 1}},
                              {VK_FORMAT_R16_SFLOAT, {1, 2}},
                              {VK_FORMAT_R16G16_SFLOAT, {2, 2}},
                              {VK_FORMAT_R16G16B16A16_SFLOAT, {4, 2}},
                              {VK_FORMAT_R32_SFLOAT, {1, 4}},
                              {VK_FORMAT_D32_SFLOAT, {1, 4}},
                              {VK_FORMAT_R32G32_SFLOAT, {2, 4}},
                              {VK_FORMAT_R32G32B32A32_SFLOAT, {4, 4}},
                              {VK_FORMAT_R8G8B8A8_SNORM, {4, 1, true}}};
  const auto* const row = std::ranges::find(kLayouts, format, &Row::first);
  return row != std::end(kLayouts) ? row->second : TexelLayout{4, 1};  // channels of 8 bits
}

float read_channel(const std::byte* data, const TexelLayout& layout) {
  switch (layout.bytes) {
    case 1:
      return layout.is_signed ? std::max(float(read<std::int8_t>(data)) / 127.0f, -1.0f)
                              : float(read<std::uint8_t>(data)) / 255.0f;
    case 2:
      return glm::unpackHalf1x16(read<std::uint16_t>(data));
    default:
      return read<float>(data);
  }
}

}  // namespace alcove::sample
