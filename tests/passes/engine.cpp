#include "engine.h"

#include <gtest/gtest.h>

namespace alcove::passes {

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
  auto created = sample::GpuImage::create(
      device_, {format, framegraph::Extent::absolute(width, height), 1, layers, samples}, usage);
  EXPECT_TRUE(created) << created.error();
  if (!created) return {};
  const VkImage image = (*created)->image();
  images_.push_back(std::move(*created));
  submit(0, [&](VkCommandBuffer commands) {
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .dstStageMask = kResting.stages,
        .dstAccessMask = kResting.access,
        .newLayout = kResting.layout,
        .image = image,
        .subresourceRange = {sample::aspect_of(format), 0, 1, 0, layers}};
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
  });
  wait();
  return {.image = image,
          .format = format,
          .width = width,
          .height = height,
          .usage = usage,
          .initial_state = kResting,
          .final_state = kResting};
}

void TestEngine::destroy_image(const AlcoveImage& image) {
  std::erase_if(images_, [&](const auto& each) { return each->image() == image.image; });
}

void TestEngine::forget_images(AlcoveContext& context) const {
  for (const auto& image : images_)
    EXPECT_EQ(alcoveForgetImage(&context, image->image()), ALCOVE_SUCCESS);
}

void TestEngine::submit(std::uint32_t slot, const std::function<void(VkCommandBuffer)>& record) {
  const Slot& used = slots_.at(slot);
  EXPECT_EQ(vkWaitForFences(device_.device(), 1, &used.fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
  EXPECT_EQ(vkResetFences(device_.device(), 1, &used.fence), VK_SUCCESS);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  EXPECT_EQ(vkBeginCommandBuffer(used.commands, &begin), VK_SUCCESS);
  record(used.commands);
  EXPECT_EQ(vkEndCommandBuffer(used.commands), VK_SUCCESS);
  const VkSubmitInfo submission{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &used.commands};
  EXPECT_EQ(vkQueueSubmit(device_.queue(), 1, &submission, used.fence), VK_SUCCESS);
}

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

void TestEngine::wait() { EXPECT_EQ(vkQueueWaitIdle(device_.queue()), VK_SUCCESS); }

}  // namespace alcove::passes
