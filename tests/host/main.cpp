// A renderer as public samples write it, with Alcove dropped in: a render pass for the g-buffer
// with automatic layout transitions, packed normals, depth with stencil, a GLM camera, two frames
// in flight, a resize, and a queue for asynchronous compute where the device has one.
//
//   alcove_host FILE.pgm [--async]
//
// It orbits the scene in a small image, resizes to the size of scene.h, draws the still view and
// writes the visibility of the last frame. The lines that an engine adds for Alcove stand between
// "Alcove: begin" and "Alcove: end"; check_host.cmake counts them.
#include <array>
#include <cstdio>
#include <cstring>

#include "base.h"
#include "camera.h"
#include "scene.h"
#include "spirv/host_gbuffer_fragment.h"
#include "spirv/host_gbuffer_vertex.h"
#include "spirv/host_lighting_fragment.h"
#include "spirv/host_lighting_vertex.h"
// Alcove: begin
#include <alcove/alcove.h>
// Alcove: end

namespace host {
namespace {

constexpr std::uint32_t kSlots = 2;  // frames in flight
constexpr VkPipelineStageFlags kFragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

class Renderer {
 public:
  explicit Renderer(bool async);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void resize(VkExtent2D size);
  void draw(float angle);
  void write_visibility(const char* file);

 private:
  struct Slot {
    VkCommandBuffer geometry = VK_NULL_HANDLE;
    VkCommandBuffer compute = VK_NULL_HANDLE;  // between geometry and lighting
    VkCommandBuffer lighting = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;     // geometry has finished; with asynchronous compute
    VkSemaphore computed = VK_NULL_HANDLE;  // compute has finished; with asynchronous compute
    VkFence finished = VK_NULL_HANDLE;
  };
  void create_context();
  void create_render_passes();
  void create_pipelines();
  void create_slots();
  void destroy_targets();
  void write_descriptors() const;
  void record_geometry(VkCommandBuffer commands, const CameraMatrices& camera) const;
  void record_occlusion(VkCommandBuffer commands, const CameraMatrices& camera);
  void record_lighting(VkCommandBuffer commands) const;
  void begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer target) const;
  void submit(const Slot& slot) const;

  Base base_;
  bool async_;
  VkExtent2D size_{};
  std::uint32_t frame_ = 0;         // since the last resize
  std::uint32_t still_frames_ = 0;  // frames in a row whose camera is that of the frame before
  CameraMatrices previous_{};
  Image depth_, normals_, visibility_, colour_;
  Buffer vertices_;
  std::uint32_t vertex_count_ = 0;
  VkRenderPass geometry_pass_ = VK_NULL_HANDLE, lighting_pass_ = VK_NULL_HANDLE;
  VkFramebuffer geometry_target_ = VK_NULL_HANDLE, lighting_target_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipelineLayout geometry_layout_ = VK_NULL_HANDLE, lighting_layout_ = VK_NULL_HANDLE;
  VkPipeline geometry_pipeline_ = VK_NULL_HANDLE, lighting_pipeline_ = VK_NULL_HANDLE;
  std::array<Slot, kSlots> slots_;
  // Alcove: begin
  AlcoveContext* alcove_ = nullptr;
  // Alcove: end
};

Renderer::Renderer(bool async) : async_(async) {
  VkPhysicalDeviceVulkan13Features features13{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = &features13};
  // Alcove: begin
  features13.synchronization2 = VK_TRUE;
  features.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  // Alcove: end
  base_.open(features, async);
  const std::vector<Vertex> scene = make_scene();
  vertex_count_ = static_cast<std::uint32_t>(scene.size());
  vertices_ =
      base_.create_buffer(scene.size() * sizeof scene[0], VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  std::memcpy(vertices_.mapped, scene.data(), scene.size() * sizeof scene[0]);
  create_render_passes();
  create_pipelines();
  create_slots();
  create_context();
}

void Renderer::create_context() {
  // Alcove: begin
  AlcoveContextInfo info{};
  info.struct_size = sizeof info;
  info.queue_family = base_.compute_family;
  info.instance = base_.instance;
  info.physical_device = base_.physical_device;
  info.device = base_.device;
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.frames_in_flight = kSlots;
  char message[ALCOVE_MAX_MESSAGE];
  require(alcoveCreateContext(&info, &alcove_, message) == ALCOVE_SUCCESS, message);
  // Alcove: end
}

Renderer::~Renderer() {
  vkDeviceWaitIdle(base_.device);
  // Alcove: begin
  alcoveDestroyContext(alcove_);
  // Alcove: end
  destroy_targets();
  for (const Slot& slot : slots_) {
    vkDestroySemaphore(base_.device, slot.drawn, nullptr);
    vkDestroySemaphore(base_.device, slot.computed, nullptr);
    vkDestroyFence(base_.device, slot.finished, nullptr);
  }
  for (const VkPipeline pipeline : {geometry_pipeline_, lighting_pipeline_}) {
    vkDestroyPipeline(base_.device, pipeline, nullptr);
  }
  for (const VkPipelineLayout layout : {geometry_layout_, lighting_layout_}) {
    vkDestroyPipelineLayout(base_.device, layout, nullptr);
  }
  vkDestroyDescriptorPool(base_.device, pool_, nullptr);
  vkDestroyDescriptorSetLayout(base_.device, set_layout_, nullptr);
  vkDestroySampler(base_.device, sampler_, nullptr);
  for (const VkRenderPass pass : {geometry_pass_, lighting_pass_}) {
    vkDestroyRenderPass(base_.device, pass, nullptr);
  }
  base_.destroy(vertices_);
  base_.close();
}

// Both passes change the layouts of their attachments at their ends, ordered by the dependency on
// what comes after them.
void Renderer::create_render_passes() {
  const auto create = [&](std::span<const VkAttachmentDescription> attachments, bool has_depth,
                          std::span<const VkSubpassDependency> dependencies) {
    const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &colour,
                                       .pDepthStencilAttachment = has_depth ? &depth : nullptr};
    const VkRenderPassCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = static_cast<std::uint32_t>(attachments.size()),
        .pAttachments = attachments.data(),
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = static_cast<std::uint32_t>(dependencies.size()),
        .pDependencies = dependencies.data()};
    VkRenderPass made = VK_NULL_HANDLE;
    require(vkCreateRenderPass(base_.device, &info, nullptr, &made), "no render pass");
    return made;
  };
  VkAttachmentDescription normals{.format = VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                  .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                  .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                  .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                  .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                  .finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkAttachmentDescription depth = normals;
  depth.format = VK_FORMAT_D32_SFLOAT_S8_UINT;
  depth.finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  VkAttachmentDescription colour = normals;
  colour.format = VK_FORMAT_R8G8B8A8_UNORM;
  colour.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  constexpr VkPipelineStageFlags kOutput = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                           VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                           VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkAccessFlags kWrites = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                                    VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                    VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const std::array geometry_dependencies{
      VkSubpassDependency{VK_SUBPASS_EXTERNAL, 0, kFragment | kOutput, kOutput, kWrites, kWrites},
      VkSubpassDependency{0, VK_SUBPASS_EXTERNAL, kOutput, kFragment, kWrites,
                          VK_ACCESS_SHADER_READ_BIT}};
  geometry_pass_ = create(std::array{normals, depth}, true, geometry_dependencies);
  const std::array lighting_dependencies{
      VkSubpassDependency{VK_SUBPASS_EXTERNAL, 0, kOutput | VK_PIPELINE_STAGE_TRANSFER_BIT, kOutput,
                          kWrites, kWrites},
      VkSubpassDependency{0, VK_SUBPASS_EXTERNAL, kOutput, VK_PIPELINE_STAGE_TRANSFER_BIT, kWrites,
                          VK_ACCESS_TRANSFER_READ_BIT}};
  lighting_pass_ = create(std::span(&colour, 1), false, lighting_dependencies);
}

void Renderer::create_pipelines() {
  const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  require(vkCreateSampler(base_.device, &sampler, nullptr, &sampler_), "no sampler");
  std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                   nullptr};
  }
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = 2,
      .pBindings = bindings.data()};
  require(vkCreateDescriptorSetLayout(base_.device, &set_info, nullptr, &set_layout_), "no layout");
  const VkDescriptorPoolSize textures{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &textures};
  require(vkCreateDescriptorPool(base_.device, &pool_info, nullptr, &pool_), "no pool");
  const VkDescriptorSetAllocateInfo allocation{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
      .descriptorPool = pool_,
      .descriptorSetCount = 1,
      .pSetLayouts = &set_layout_};
  require(vkAllocateDescriptorSets(base_.device, &allocation, &set_), "no descriptor set");
  const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(glm::mat4)};
  VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                    .pushConstantRangeCount = 1,
                                    .pPushConstantRanges = &push};
  require(vkCreatePipelineLayout(base_.device, &layout, nullptr, &geometry_layout_), "no layout");
  layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
            .setLayoutCount = 1,
            .pSetLayouts = &set_layout_};
  require(vkCreatePipelineLayout(base_.device, &layout, nullptr, &lighting_layout_), "no layout");
  geometry_pipeline_ = base_.create_pipeline({{kHostGbufferVertex, sizeof kHostGbufferVertex},
                                              {kHostGbufferFragment, sizeof kHostGbufferFragment},
                                              geometry_layout_,
                                              geometry_pass_,
                                              true});
  lighting_pipeline_ = base_.create_pipeline({{kHostLightingVertex, sizeof kHostLightingVertex},
                                              {kHostLightingFragment, sizeof kHostLightingFragment},
                                              lighting_layout_,
                                              lighting_pass_,
                                              false});
}

void Renderer::create_slots() {
  const VkSemaphoreCreateInfo semaphore{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                .flags = VK_FENCE_CREATE_SIGNALED_BIT};
  for (Slot& slot : slots_) {
    slot.geometry = base_.allocate_commands(base_.graphics_family);
    slot.compute = base_.allocate_commands(base_.compute_family);
    slot.lighting = base_.allocate_commands(base_.graphics_family);
    require(vkCreateSemaphore(base_.device, &semaphore, nullptr, &slot.drawn), "no semaphore");
    require(vkCreateSemaphore(base_.device, &semaphore, nullptr, &slot.computed), "no semaphore");
    require(vkCreateFence(base_.device, &fence, nullptr, &slot.finished), "no fence");
  }
}

void Renderer::destroy_targets() {
  vkDestroyFramebuffer(base_.device, geometry_target_, nullptr);
  vkDestroyFramebuffer(base_.device, lighting_target_, nullptr);
  for (Image* image : {&depth_, &normals_, &visibility_, &colour_}) {
    base_.destroy(*image);
  }
}

void Renderer::resize(VkExtent2D size) {
  vkDeviceWaitIdle(base_.device);
  // Alcove: begin
  for (const Image& image : {depth_, normals_, visibility_})
    alcoveForgetImage(alcove_, image.image);
  // Alcove: end
  destroy_targets();
  size_ = size;
  frame_ = 0;
  depth_ =
      base_.create_image(VK_FORMAT_D32_SFLOAT_S8_UINT, size,
                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  normals_ = base_.create_image(VK_FORMAT_A2B10G10R10_UNORM_PACK32, size,
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
    VkFramebuffer made = VK_NULL_HANDLE;
    require(vkCreateFramebuffer(base_.device, &info, nullptr, &made), "no framebuffer");
    return made;
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

// Alcove: begin
AlcoveImage describe(const Image& image, VkExtent2D size, AlcoveState before, AlcoveState after) {
  AlcoveImage result{};
  result.image = image.image;
  result.format = image.format;
  result.usage = image.usage;
  result.width = size.width;
  result.height = size.height;
  result.initial_state = before;
  result.final_state = after;
  return result;
}
// Alcove: end

void Renderer::record_occlusion(VkCommandBuffer commands, const CameraMatrices& camera) {
  // Alcove: begin
  // With a semaphore on either side, the stage that waits and no access; else the destination of
  // the render pass's dependency.
  const AlcoveState read{
      async_ ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
      async_ ? VK_ACCESS_2_NONE : VK_ACCESS_2_SHADER_READ_BIT,
      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  AlcoveState depth = read, written = read;
  depth.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  written.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  AlcoveSettings settings{};
  settings.struct_size = sizeof settings;
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, kRadius, &settings);
  AlcoveView view{};
  view.struct_size = sizeof view;
  view.settings = &settings;
  view.normal_encoding = ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ;
  view.static_frames = still_frames_;
  alcoveConvertCamera(&camera.projection[0][0], &camera.view[0][0], 0, &view.camera);
  alcoveConvertCamera(&previous_.projection[0][0], &previous_.view[0][0], 0, &view.previous_camera);
  view.depth = describe(depth_, size_, depth, depth);
  view.normals = describe(normals_, size_, read, read);
  view.visibility = describe(visibility_, size_, written, read);
  AlcoveFrame frame{sizeof frame, frame_, frame_ % kSlots, 1, &view, VK_TRUE};
  const bool recorded = alcoveRecordFrame(alcove_, commands, &frame) == ALCOVE_SUCCESS;
  require(recorded, alcoveGetMessage(alcove_));
  // Alcove: end
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
  if (!async_) {
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
  const CameraMatrices camera = camera_matrices(angle, aspect);
  still_frames_ =
      frame_ > 0 && camera.view == previous_.view && camera.projection == previous_.projection
          ? still_frames_ + 1
          : 0;
  const Slot& slot = slots_[frame_ % kSlots];
  require(vkWaitForFences(base_.device, 1, &slot.finished, VK_TRUE, UINT64_MAX), "device lost");
  require(vkResetFences(base_.device, 1, &slot.finished), "cannot reset a fence");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  for (const VkCommandBuffer commands : {slot.geometry, slot.compute, slot.lighting}) {
    require(vkBeginCommandBuffer(commands, &begin), "cannot record commands");
  }
  record_geometry(slot.geometry, camera);
  record_occlusion(slot.compute, camera);
  record_lighting(slot.lighting);
  for (const VkCommandBuffer commands : {slot.geometry, slot.compute, slot.lighting}) {
    require(vkEndCommandBuffer(commands), "cannot record commands");
  }
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
  // Alcove: begin
  char mistakes[2048];
  require(alcoveDiagnose(alcove_, mistakes, sizeof mistakes) == 0, mistakes);
  // Alcove: end
}

}  // namespace
}  // namespace host

int main(int argc, char** argv) {
  const bool async = argc == 3 && std::strcmp(argv[2], "--async") == 0;
  host::require(argc == 2 || async, "usage: alcove_host FILE.pgm [--async]");
  host::Renderer renderer(async);
  renderer.resize({240, 135});
  for (int i = 0; i < 9; ++i) {
    renderer.draw(-0.3f + 0.03f * static_cast<float>(i));
  }
  renderer.resize({host::kWidth, host::kHeight});
  for (std::uint32_t i = 0; i < host::kStillFrames; ++i) {
    renderer.draw(0.0f);
  }
  renderer.write_visibility(argv[1]);
  return 0;
}
