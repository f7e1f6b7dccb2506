// The images of the host's renderer and the commands of its frames.
#include "renderer.h"

#include <cstdio>
#include <span>

namespace host {

void Renderer::destroy_targets() {
  vkDestroyFramebuffer(base_.device, geometry_target_, nullptr);
  vkDestroyFramebuffer(base_.device, lighting_target_, nullptr);
  for (Image* image : {&depth_, &normals_, &visibility_, &colour_}) base_.destroy(*image);
}

void Renderer::resize(VkExtent2D size) {
  vkDeviceWaitIdle(base_.device);
  forget_images();
  destroy_targets();
  size_ = size;
  frame_ = 0;
  depth_ =
      base_.create_image(VK_FORMAT_D32_SFLOAT_S8_UINT, size,
                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  normals_ = base_.create_image(normal_format(options_), size,
                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  colour_ =
      base_.create_image(VK_FORMAT_R8G8B8A8_UNORM, size,
                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  // Alcove: begin
  visibility_ = base_.create_image(
      VK_FORMAT_R8_UNORM, size,
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  // Alcove: end
  const auto create = [&](VkRenderPass pass, std::span<const VkImageView> views) {
    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = pass,
                                       .attachmentCount = static_cast<std::uint32_t>(views.size()),
                                       .pAttachments = views.data(),
                                       .width = size.width,
                                       .height = size.height,
                                       .layers = 1};
    return base_.create(vkCreateFramebuffer, info);
  };
  geometry_target_ = create(geometry_pass_, std::array{normals_.view, depth_.view});
  lighting_target_ = create(lighting_pass_, std::array{colour_.view});
  write_descriptors();
}

void Renderer::write_descriptors() const {
  std::array<VkDescriptorImageInfo, 2> images{};
  images[0] = {sampler_, normals_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  // Alcove: begin
  images[1] = {sampler_, visibility_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  // Alcove: end
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .descriptorCount = 2,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = images.data()};
  vkUpdateDescriptorSets(base_.device, 1, &write, 0, nullptr);
}

void Renderer::begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer target) const {
  std::array<VkClearValue, 2> clear{};
  clear[1].depthStencil = {1.0f, 0};
  const VkRenderPassBeginInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = pass,
                                   .framebuffer = target,
                                   .renderArea = {{0, 0}, size_},
                                   .clearValueCount = 2,
                                   .pClearValues = clear.data()};
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(size_.width), static_cast<float>(size_.height), 0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

void Renderer::record_geometry(VkCommandBuffer commands, const CameraMatrices& camera) const {
  begin_pass(commands, geometry_pass_, geometry_target_);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, geometry_pipeline_);
  const glm::mat4 clip_from_world = camera.projection * camera.view;
  vkCmdPushConstants(commands, geometry_layout_, VK_SHADER_STAGE_VERTEX_BIT, 0,
                     sizeof clip_from_world, &clip_from_world);
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices_.buffer, &offset);
  vkCmdDraw(commands, vertex_count_, 1, 0, 0);
  vkCmdEndRenderPass(commands);
}

void Renderer::record_lighting(VkCommandBuffer commands) const {
  begin_pass(commands, lighting_pass_, lighting_target_);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, lighting_pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, lighting_layout_, 0, 1, &set_,
                          0, nullptr);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRenderPass(commands);
}

void Renderer::submit(const Slot& slot) const {
  const std::array all{slot.geometry, slot.compute, slot.lighting};
  VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 3,
                    .pCommandBuffers = all.data()};
  if (!options_.async) {
    require(vkQueueSubmit(base_.graphics_queue, 1, &info, slot.finished), "submission failed");
    return;
  }
  const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
  info.commandBufferCount = 1;
  info.signalSemaphoreCount = 1;
  info.pSignalSemaphores = &slot.drawn;
  require(vkQueueSubmit(base_.graphics_queue, 1, &info, VK_NULL_HANDLE), "submission failed");
  info.pCommandBuffers = &all[1];
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &slot.drawn;
  info.pWaitDstStageMask = &compute;
  info.pSignalSemaphores = &slot.computed;
  require(vkQueueSubmit(base_.compute_queue, 1, &info, VK_NULL_HANDLE), "submission failed");
  info.pCommandBuffers = &all[2];
  info.pWaitSemaphores = &slot.computed;
  info.pWaitDstStageMask = &kFragment;
  info.signalSemaphoreCount = 0;
  require(vkQueueSubmit(base_.graphics_queue, 1, &info, slot.finished), "submission failed");
}

void Renderer::draw(float angle) {
  const float aspect = static_cast<float>(size_.width) / static_cast<float>(size_.height);
  const CameraMatrices camera = camera_matrices(options_.eye, angle, aspect);
  still_frames_ =
      frame_ > 0 && camera.view == previous_.view && camera.projection == previous_.projection
          ? still_frames_ + 1
          : 0;
  const Slot& slot = slots_[frame_ % kSlots];
  require(vkWaitForFences(base_.device, 1, &slot.finished, VK_TRUE, UINT64_MAX), "device lost");
  require(vkResetFences(base_.device, 1, &slot.finished), "cannot reset a fence");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  for (const VkCommandBuffer commands : {slot.geometry, slot.compute, slot.lighting})
    require(vkBeginCommandBuffer(commands, &begin), "cannot record commands");
  record_geometry(slot.geometry, camera);
  record_occlusion(slot.compute, camera);
  record_lighting(slot.lighting);
  for (const VkCommandBuffer commands : {slot.geometry, slot.compute, slot.lighting})
    require(vkEndCommandBuffer(commands), "cannot record commands");
  submit(slot);
  previous_ = camera;
  ++frame_;
}

void Renderer::write_visibility(const char* file) {
  vkDeviceWaitIdle(base_.device);
  const std::size_t bytes = std::size_t{size_.width} * size_.height;
  Buffer buffer = base_.create_buffer(bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkCommandBuffer commands = slots_[0].lighting;
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  require(vkBeginCommandBuffer(commands, &begin), "cannot record commands");
  const VkImageMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
                                     .oldLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .image = visibility_.image,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  vkCmdPipelineBarrier(commands, kFragment, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
  const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {size_.width, size_.height, 1}};
  vkCmdCopyImageToBuffer(commands, visibility_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         buffer.buffer, 1, &region);
  require(vkEndCommandBuffer(commands), "cannot record commands");
  const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .commandBufferCount = 1,
                          .pCommandBuffers = &commands};
  require(vkQueueSubmit(base_.graphics_queue, 1, &info, VK_NULL_HANDLE), "submission failed");
  vkDeviceWaitIdle(base_.device);
  std::FILE* out = std::fopen(file, "wb");
  require(out != nullptr, "the file cannot be written");
  std::fprintf(out, "P5\n%u %u\n255\n", size_.width, size_.height);
  const bool written = std::fwrite(buffer.mapped, 1, bytes, out) == bytes;
  require(std::fclose(out) == 0 && written, "the file cannot be written");
  base_.destroy(buffer);
  require_no_mistakes();
}

}  // namespace host
