// Creation and destruction of everything that lives as long as the host's renderer.
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "renderer.h"
#include "scene.h"
#include "spirv/host_gbuffer_fragment.h"
#include "spirv/host_gbuffer_vertex.h"
#include "spirv/host_lighting_fragment.h"
#include "spirv/host_lighting_vertex.h"

namespace host {

Renderer::Renderer(const Options& options) : options_(options) {
  VkPhysicalDeviceVulkan13Features features13{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = &features13};
  request_features(features, features13);
  base_.open(features, options.async);
  const std::vector<Vertex> scene = make_scene();
  vertex_count_ = static_cast<std::uint32_t>(scene.size());
  vertices_ =
      base_.create_buffer(scene.size() * sizeof scene[0], VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  std::memcpy(vertices_.mapped, scene.data(), scene.size() * sizeof scene[0]);
  create_render_passes();
  create_pipelines();
  create_slots();
  create_occlusion();
}

Renderer::~Renderer() {
  vkDeviceWaitIdle(base_.device);
  destroy_occlusion();
  destroy_targets();
  for (const Slot& slot : slots_) {
    vkDestroySemaphore(base_.device, slot.drawn, nullptr);
    vkDestroySemaphore(base_.device, slot.computed, nullptr);
    vkDestroyFence(base_.device, slot.finished, nullptr);
  }
  for (const VkPipeline pipeline : {geometry_pipeline_, lighting_pipeline_})
    vkDestroyPipeline(base_.device, pipeline, nullptr);
  for (const VkPipelineLayout layout : {geometry_layout_, lighting_layout_})
    vkDestroyPipelineLayout(base_.device, layout, nullptr);
  vkDestroyDescriptorPool(base_.device, pool_, nullptr);
  vkDestroyDescriptorSetLayout(base_.device, set_layout_, nullptr);
  vkDestroySampler(base_.device, sampler_, nullptr);
  for (const VkRenderPass pass : {geometry_pass_, lighting_pass_})
    vkDestroyRenderPass(base_.device, pass, nullptr);
  base_.destroy(vertices_);
  base_.close();
}

// Each render pass changes the layouts of its attachments when it ends. Its second subpass
// dependency orders the change before the commands that use the attachments afterwards.
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
    return base_.create(vkCreateRenderPass, info);
  };
  VkAttachmentDescription normals{.format = normal_format(options_),
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
  sampler_ = base_.create(vkCreateSampler, sampler);
  std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                   nullptr};
  }
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = 2,
      .pBindings = bindings.data()};
  set_layout_ = base_.create(vkCreateDescriptorSetLayout, set_info);
  const VkDescriptorPoolSize textures{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &textures};
  pool_ = base_.create(vkCreateDescriptorPool, pool_info);
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
  geometry_layout_ = base_.create(vkCreatePipelineLayout, layout);
  layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
            .setLayoutCount = 1,
            .pSetLayouts = &set_layout_};
  lighting_layout_ = base_.create(vkCreatePipelineLayout, layout);
  const VkBool32 packed = options_.float_normals ? VK_FALSE : VK_TRUE;
  geometry_pipeline_ = base_.create_pipeline(
      {kHostGbufferVertex, kHostGbufferFragment, geometry_layout_, geometry_pass_, true, packed});
  lighting_pipeline_ = base_.create_pipeline({kHostLightingVertex, kHostLightingFragment,
                                              lighting_layout_, lighting_pass_, false, packed});
}

void Renderer::create_slots() {
  const VkSemaphoreCreateInfo semaphore{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                .flags = VK_FENCE_CREATE_SIGNALED_BIT};
  for (Slot& slot : slots_) {
    slot.geometry = base_.allocate_commands(base_.graphics_family);
    slot.compute = base_.allocate_commands(base_.compute_family);
    slot.lighting = base_.allocate_commands(base_.graphics_family);
    slot.drawn = base_.create(vkCreateSemaphore, semaphore);
    slot.computed = base_.create(vkCreateSemaphore, semaphore);
    slot.finished = base_.create(vkCreateFence, fence);
  }
}

}  // namespace host
