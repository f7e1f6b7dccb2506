#include "render/gbuffer_pipelines.h"

#include <span>

#include "render/gbuffer.h"
#include "render/gpu_meshes.h"
#include "render/shader_module.h"
#include "render/shaders/gbuffer.h"
#include "spirv/gbuffer_fragment.h"
#include "spirv/gbuffer_vertex.h"
#include "spirv/second_layer_fragment.h"
#include "spirv/second_layer_vertex.h"

namespace alcove::sample {
namespace {

constexpr std::array<VkFormat, 4> kColourFormats{kNormalFormat, kAlbedoFormat, kMotionFormat,
                                                 kEmissiveFormat};

constexpr std::uint32_t binding_of(VertexStream stream) {
  return static_cast<std::uint32_t>(stream);
}

// The state that all pipelines have in common: the vertex streams of MeshDraw, and no blending.
struct FixedState {
  std::array<VkVertexInputBindingDescription, kVertexStreams> bindings{};
  // Locations are those of shaders/gbuffer_vertex.h. The attributes that the second layer reads
  // come first.
  std::array<VkVertexInputAttributeDescription, 9> attributes{
      {{0, binding_of(VertexStream::kPosition), VK_FORMAT_R32G32B32_SFLOAT, 0},
       {2, binding_of(VertexStream::kUv), VK_FORMAT_R32G32_SFLOAT, 0},
       {3, binding_of(VertexStream::kSecondUv), VK_FORMAT_R32G32_SFLOAT, 0},
       {5, binding_of(VertexStream::kColor), VK_FORMAT_R8G8B8A8_UNORM, 0},
       {6, binding_of(VertexStream::kInstance), VK_FORMAT_R32G32B32A32_SFLOAT, 0},
       {7, binding_of(VertexStream::kInstance), VK_FORMAT_R32G32B32A32_SFLOAT, 16},
       {8, binding_of(VertexStream::kInstance), VK_FORMAT_R32G32B32A32_SFLOAT, 32},
       {1, binding_of(VertexStream::kNormals), VK_FORMAT_R16G16B16A16_SNORM, 0},
       {4, binding_of(VertexStream::kTangent), VK_FORMAT_R16G16B16A16_SNORM, 0}}};
  static constexpr std::uint32_t kDepthAttributes = 7;
  VkPipelineVertexInputStateCreateInfo vertices{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = kVertexStreams,
      .pVertexBindingDescriptions = bindings.data(),
      .vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size()),
      .pVertexAttributeDescriptions = attributes.data()};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
      .viewportCount = 1,
      .scissorCount = 1};
  VkPipelineRasterizationStateCreateInfo rasterisation{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1.0f};
  VkPipelineMultisampleStateCreateInfo multisample{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
      .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  std::array<VkPipelineColorBlendAttachmentState, 4> attachments{};
  VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
      .attachmentCount = 4,
      .pAttachments = attachments.data()};
  std::array<VkDynamicState, 5> dynamic_states{
      VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE,
      VK_DYNAMIC_STATE_FRONT_FACE, VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE};
  VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = static_cast<uint32_t>(dynamic_states.size()),
      .pDynamicStates = dynamic_states.data()};
  VkPipelineRenderingCreateInfo rendering{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = static_cast<uint32_t>(kColourFormats.size()),
      .pColorAttachmentFormats = kColourFormats.data(),
      .depthAttachmentFormat = kDepthFormat};

  explicit FixedState(bool depth_alone) {
    for (std::uint32_t i = 0; i < kVertexStreams; ++i) {
      bindings[i] = {i, 0, VK_VERTEX_INPUT_RATE_VERTEX};
    }
    bindings[binding_of(VertexStream::kInstance)].inputRate = VK_VERTEX_INPUT_RATE_INSTANCE;
    if (depth_alone) {
      vertices.vertexAttributeDescriptionCount = kDepthAttributes;
    }
    for (auto& attachment : attachments) {
      attachment.colorWriteMask = 0xf;
    }
  }
  FixedState(const FixedState&) = delete;
  FixedState& operator=(const FixedState&) = delete;
};

VkResult create_set_layout(VkDevice device, std::span<const VkDescriptorSetLayoutBinding> bindings,
                           VkDescriptorSetLayout& made) {
  const VkDescriptorSetLayoutCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = static_cast<uint32_t>(bindings.size()),
      .pBindings = bindings.data()};
  return vkCreateDescriptorSetLayout(device, &info, nullptr, &made);
}

}  // namespace

tl::expected<std::unique_ptr<GbufferPipelines>, std::string> GbufferPipelines::create(
    VkDevice device, bool geometric_normals) {
  std::unique_ptr<GbufferPipelines> made(new GbufferPipelines(device));
  VkResult result = made->create_layout();
  for (const Kind kind : {Kind::all, Kind::second_layer}) {
    if (result == VK_SUCCESS) {
      result = made->create_pipelines(kind, geometric_normals);
    }
  }
  if (result != VK_SUCCESS) {
    return device_failure("create the pipelines of the g-buffer", result);
  }
  return made;
}

GbufferPipelines::~GbufferPipelines() {
  for (const VkPipeline pipeline : pipelines_) {
    vkDestroyPipeline(device_, pipeline, nullptr);
  }
  vkDestroyPipelineLayout(device_, layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_, material_set_, nullptr);
  vkDestroyDescriptorSetLayout(device_, layer_set_, nullptr);
  vkDestroyDescriptorSetLayout(device_, frame_set_, nullptr);
}

VkResult GbufferPipelines::create_layout() {
  const std::array<VkDescriptorSetLayoutBinding, 1> frame{
      {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, kDrawStages, nullptr}}};
  const std::array<VkDescriptorSetLayoutBinding, 1> layer{
      {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}}};
  const std::array<VkDescriptorSetLayoutBinding, 2> material{
      {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, maths::kMaterialTextures,
        VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
       {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kDrawStages, nullptr}}};
  VkResult result = create_set_layout(device_, frame, frame_set_);
  if (result == VK_SUCCESS) {
    result = create_set_layout(device_, layer, layer_set_);
  }
  if (result == VK_SUCCESS) {
    result = create_set_layout(device_, material, material_set_);
  }
  if (result != VK_SUCCESS) {
    return result;
  }
  const std::array sets{frame_set_, layer_set_, material_set_};
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(maths::GbufferDraw)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = static_cast<uint32_t>(sets.size()),
                                        .pSetLayouts = sets.data(),
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &range};
  return vkCreatePipelineLayout(device_, &info, nullptr, &layout_);
}

VkResult GbufferPipelines::create_pipelines(Kind kind, bool geometric_normals) {
  const uint32_t geometric = geometric_normals ? 1 : 0;
  const VkSpecializationMapEntry entry{0, 0, sizeof geometric};
  const VkSpecializationInfo specialisation{1, &entry, sizeof geometric, &geometric};
  const bool second = kind == Kind::second_layer;
  using Code = std::span<const uint32_t>;
  const ShaderStages stages(device_, second ? Code(kSecondLayerVertex) : Code(kGbufferVertex),
                            second ? Code(kSecondLayerFragment) : Code(kGbufferFragment),
                            &specialisation);
  if (stages.result != VK_SUCCESS) {
    return stages.result;
  }
  const FixedState fixed(second);
  for (const bool reversed : {false, true}) {
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS};
    const VkGraphicsPipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &fixed.rendering,
        .stageCount = static_cast<uint32_t>(stages.infos.size()),
        .pStages = stages.infos.data(),
        .pVertexInputState = &fixed.vertices,
        .pInputAssemblyState = &fixed.assembly,
        .pViewportState = &fixed.viewport,
        .pRasterizationState = &fixed.rasterisation,
        .pMultisampleState = &fixed.multisample,
        .pDepthStencilState = &depth,
        .pColorBlendState = &fixed.blend,
        .pDynamicState = &fixed.dynamic,
        .layout = layout_};
    const VkResult result = vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr,
                                                      &pipelines_[index_of(kind, reversed)]);
    if (result != VK_SUCCESS) {
      return result;
    }
  }
  return VK_SUCCESS;
}

}  // namespace alcove::sample
