#include "engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "gpu/gpu_image.h"

namespace alcove::passes {
namespace {

// Changes the layout of an image between its use by any commands.
void change_layout(VkCommandBuffer commands, const AlcoveImage& image, VkImageLayout from,
                   VkImageLayout to) {
  const VkImageMemoryBarrier barrier{
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
      .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
      .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
      .oldLayout = from,
      .newLayout = to,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image.image,
      .subresourceRange = {sample::aspect_of(image.format), 0, 1, image.layer,
                           from == VK_IMAGE_LAYOUT_UNDEFINED ? VK_REMAINING_ARRAY_LAYERS : 1}};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

VkBufferImageCopy whole(const AlcoveImage& image) {
  return {.imageSubresource = {sample::aspect_of(image.format), 0, image.layer, 1},
          .imageExtent = {image.width, image.height, 1}};
}

}  // namespace

framegraph::ImportedTexture import_of(const AlcoveImage& image) {
  const auto to_state = [](const AlcoveState& state) {
    return framegraph::State{state.stages, state.access, state.layout};
  };
  return {.image = image.image,
          .desc = {image.format, framegraph::Extent::absolute(image.width, image.height)},
          .usage = image.usage,
          .initial_state = to_state(image.initial_state),
          .final_state = to_state(image.final_state)};
}

TestEngine::TestEngine(const sample::VulkanDevice& device) : device_(device) {
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = device.queue_family()};
  EXPECT_EQ(vkCreateCommandPool(device.device(), &pool, nullptr, &pool_), VK_SUCCESS);
  for (Slot& slot : slots_) {
    const VkCommandBufferAllocateInfo commands{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool_,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    EXPECT_EQ(vkAllocateCommandBuffers(device.device(), &commands, &slot.commands), VK_SUCCESS);
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                  .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    EXPECT_EQ(vkCreateFence(device.device(), &fence, nullptr, &slot.fence), VK_SUCCESS);
  }
}

TestEngine::~TestEngine() {
  wait();
  for (const Slot& slot : slots_) vkDestroyFence(device_.device(), slot.fence, nullptr);
  vkDestroyCommandPool(device_.device(), pool_, nullptr);
}

AlcoveContextInfo TestEngine::context_info() const {
  return {.struct_size = sizeof(AlcoveContextInfo),
          .queue_family = device_.queue_family(),
          .instance = device_.instance(),
          .physical_device = device_.physical_device(),
          .device = device_.device(),
          .get_instance_proc_addr = vkGetInstanceProcAddr,
          .frames_in_flight = kSlots,
          .timestamps = VK_TRUE};
}

AlcoveImage TestEngine::make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                                   VkImageUsageFlags usage, std::uint32_t layers,
                                   VkSampleCountFlagBits samples) {
  auto object = sample::GpuImage::create(device_,
                                         {.format = format,
                                          .extent = framegraph::Extent::absolute(width, height),
                                          .layers = layers,
                                          .samples = samples},
                                         usage);
  EXPECT_TRUE(object) << object.error();
  const AlcoveImage image{.image = (*object)->image(),
                          .format = format,
                          .width = width,
                          .height = height,
                          .usage = usage,
                          .initial_state = kResting,
                          .final_state = kResting};
  images_.push_back(std::move(*object));
  submit(0, [&](VkCommandBuffer commands) {
    change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, kResting.layout);
  });
  wait();
  return image;
}

AlcoveImage TestEngine::make_filled(VkFormat format, std::uint32_t width, std::uint32_t height,
                                    std::span<const std::byte> texels,
                                    VkImageUsageFlags further_usage) {
  const AlcoveImage image =
      make_image(format, width, height,
                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | further_usage);
  write(image, texels);
  return image;
}

AlcoveView TestEngine::make_view(const AlcoveSettings& settings, std::uint32_t width,
                                 std::uint32_t height,
                                 std::initializer_list<AlcoveImageRole> roles) {
  AlcoveView view{.struct_size = sizeof view, .info = {.settings = &settings}};
  const auto format_of = [](AlcoveImageRole role) {
    switch (role) {
      case ALCOVE_IMAGE_DEPTH:
        return VK_FORMAT_R32_SFLOAT;
      case ALCOVE_IMAGE_NORMALS:
        return VK_FORMAT_R16G16B16A16_SFLOAT;
      case ALCOVE_IMAGE_BENT_NORMAL:
        return VK_FORMAT_R8G8B8A8_SNORM;
      case ALCOVE_IMAGE_ALBEDO:
      case ALCOVE_IMAGE_MULTI_BOUNCE:
        return VK_FORMAT_R8G8B8A8_UNORM;
      default:
        return VK_FORMAT_R8_UNORM;
    }
  };
  for (const AlcoveImageRole role : roles)
    view.images[role] =
        make_image(format_of(role), width, height,
                   VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  return view;
}

void TestEngine::destroy_image(const AlcoveImage& image) {
  std::erase_if(images_, [&](const auto& each) { return each->image() == image.image; });
}

void TestEngine::forget_images(AlcoveContext& context) const {
  for (const auto& image : images_)
    EXPECT_EQ(alcoveForgetImage(&context, image->image()), ALCOVE_SUCCESS);
}

std::unique_ptr<sample::HostBuffer> TestEngine::create_buffer(VkBufferUsageFlags usage,
                                                              VkDeviceSize size) const {
  auto buffer = sample::HostBuffer::create(device_, size, usage);
  EXPECT_TRUE(buffer) << buffer.error();
  return std::move(*buffer);
}

void TestEngine::write(const AlcoveImage& image, std::span<const std::byte> texels,
                       const AlcoveState& final_state) {
  const auto buffer = create_buffer(VK_BUFFER_USAGE_TRANSFER_SRC_BIT, texels.size());
  std::ranges::copy(texels, buffer->bytes().begin());
  submit(0, [&](VkCommandBuffer commands) {
    constexpr VkImageLayout kFilled = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    const VkBufferImageCopy copy = whole(image);
    change_layout(commands, image, kResting.layout, kFilled);
    vkCmdCopyBufferToImage(commands, buffer->buffer(), image.image, kFilled, 1, &copy);
    change_layout(commands, image, kFilled, final_state.layout);
  });
  wait();
}

Bytes TestEngine::read(const AlcoveImage& image) {
  const sample::TexelLayout layout = sample::texel_layout(image.format);
  const auto buffer =
      create_buffer(VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                    std::size_t{image.width} * image.height * layout.channels * layout.bytes);
  submit(0, [&](VkCommandBuffer commands) {
    constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkBufferImageCopy copy = whole(image);
    change_layout(commands, image, image.final_state.layout, kRead);
    vkCmdCopyImageToBuffer(commands, image.image, kRead, buffer->buffer(), 1, &copy);
    change_layout(commands, image, kRead, image.final_state.layout);
  });
  wait();
  return {buffer->bytes().begin(), buffer->bytes().end()};
}

void TestEngine::record(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& record) {
  const Slot& entry = slots_.at(slot);
  EXPECT_EQ(vkWaitForFences(device_.device(), 1, &entry.fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  EXPECT_EQ(vkBeginCommandBuffer(entry.commands, &begin), VK_SUCCESS);
  record(entry.commands);
  EXPECT_EQ(vkEndCommandBuffer(entry.commands), VK_SUCCESS);
}

void TestEngine::submit(std::uint32_t slot) {
  const Slot& entry = slots_.at(slot);
  const VkSubmitInfo submission{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &entry.commands};
  EXPECT_EQ(vkResetFences(device_.device(), 1, &entry.fence), VK_SUCCESS);
  EXPECT_EQ(vkQueueSubmit(device_.queue(), 1, &submission, entry.fence), VK_SUCCESS);
}

void TestEngine::submit(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& commands) {
  record(slot, commands);
  submit(slot);
}

void TestEngine::wait() { EXPECT_EQ(vkQueueWaitIdle(device_.queue()), VK_SUCCESS); }

AlcoveSettings get_settings(AlcoveQuality quality, float radius) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  EXPECT_EQ(alcoveGetSettings(quality, radius, &settings), ALCOVE_SUCCESS);
  return settings;
}

void throw_away(VkCommandBuffer commands) {
  vkResetCommandBuffer(commands, 0);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkBeginCommandBuffer(commands, &begin);
}

Context create_context(const AlcoveContextInfo& info) {
  AlcoveContext* handle = nullptr;
  char message[ALCOVE_MAX_MESSAGE];
  EXPECT_EQ(alcoveCreateContext(&info, &handle, message), ALCOVE_SUCCESS) << message;
  EXPECT_STREQ(message, "");
  return Context(handle);
}

namespace {

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name) {
  const auto replacement = replaced_functions.find(std::string_view(name));
  return replacement != replaced_functions.end() ? replacement->second
                                                 : vkGetDeviceProcAddr(device, name);
}

}  // namespace

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_replaced_function(VkInstance instance,
                                                               const char* name) {
  if (std::string_view(name) == "vkGetDeviceProcAddr") return untyped(&get_device_function);
  const auto replacement = replaced_functions.find(std::string_view(name));
  return replacement != replaced_functions.end() ? replacement->second
                                                 : vkGetInstanceProcAddr(instance, name);
}

}  // namespace alcove::passes
