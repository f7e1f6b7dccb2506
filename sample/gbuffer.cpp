#include "gbuffer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "gpu_textures.h"
#include "shader_module.h"
#include "shaders/gbuffer.h"
#include "spirv/gbuffer_fragment.h"
#include "spirv/gbuffer_vertex.h"
#include "triangles.h"

namespace alcove::sample {
namespace {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using Failure = tl::unexpected<std::string>;

constexpr std::array<VkFormat, 4> kColourFormats{kNormalFormat, kAlbedoFormat, kMotionFormat,
                                                 kEmissiveFormat};

// From one frame's parameters to the next's: a multiple of the largest alignment that a device may
// ask for.
constexpr std::uint32_t kParameterStride = 512;
static_assert(sizeof(maths::GbufferParameters) <= kParameterStride && kParameterStride % 256 == 0);

// That read what each draw pushes.
constexpr VkShaderStageFlags kDrawStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

Failure failure(const char* what, VkResult result) {
  return Failure(std::string("The device could not create ") + what + " of the g-buffer (" +
                 std::string(result_name(result)) + ").");
}

maths::GbufferDraw draw_constants(const Material& material, const GpuTextures& textures) {
  maths::GbufferDraw draw{};
  draw.base_colour = material.base_color;
  draw.emissive = glm::vec4(material.emissive, 0.0f);
  draw.metallic = material.metallic;
  draw.roughness = material.roughness;
  draw.alpha_cutoff = material.alpha_mode == AlphaMode::kOpaque ? 0.0f : material.alpha_cutoff;
  draw.base_colour_texture = textures.index_of(material.base_color_texture, true);
  draw.metallic_roughness_texture = textures.index_of(material.metal_roughness_texture, false);
  draw.emissive_texture = textures.index_of(material.emissive_texture, true);
  if (material.normal_texture.image >= 0) {
    draw.normal_texture = textures.index_of(material.normal_texture, false);
  }
  draw.normal_scale = material.normal_scale;
  return draw;
}

}  // namespace

struct GbufferRenderer::State {
  explicit State(Gpu& owner) : gpu(owner), device(owner.device().device()) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();

  tl::expected<void, std::string> upload(const Scene& scene);
  tl::expected<void, std::string> create_layout();
  tl::expected<void, std::string> create_pipeline(bool geometric_normals);
  tl::expected<void, std::string> create_set();
  // Returns where in the parameters those of the view are.
  std::uint32_t write_parameters(const GbufferView& view);
  // Draws all faces or, with VK_CULL_MODE_FRONT_BIT, the back ones alone.
  void record(RecordContext& context, const Gbuffer& gbuffer, bool reversed_z,
              std::uint32_t parameters_at, VkCullModeFlags culled) const;
  void begin_rendering(RecordContext& context, const Gbuffer& gbuffer, bool reversed_z) const;

  uint32_t texture_count() const { return static_cast<uint32_t>(textures->descriptors().size()); }

  Gpu& gpu;
  VkDevice device;
  std::vector<TriangleDraw> draws;
  std::vector<maths::GbufferDraw> constants;
  std::unique_ptr<HostBuffer> vertices;
  std::unique_ptr<HostBuffer> parameters;  // one for each frame in flight
  std::optional<GbufferView> written;      // the latest of them
  std::uint32_t latest = 0;                // where it is
  std::unique_ptr<GpuTextures> textures;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;           // nearer is less
  VkPipeline reversed_pipeline = VK_NULL_HANDLE;  // nearer is greater
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
};

GbufferRenderer::State::~State() {
  vkDestroyDescriptorPool(device, pool, nullptr);
  vkDestroyPipeline(device, pipeline, nullptr);
  vkDestroyPipeline(device, reversed_pipeline, nullptr);
  vkDestroyPipelineLayout(device, layout, nullptr);
  vkDestroyDescriptorSetLayout(device, set_layout, nullptr);
}

tl::expected<void, std::string> GbufferRenderer::State::upload(const Scene& scene) {
  const Triangles triangles = flatten(scene);
  draws = triangles.draws;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(triangles.vertices));
  auto vertex_buffer = HostBuffer::create(gpu.device(), std::max<std::size_t>(bytes.size(), 4),
                                          VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  if (!vertex_buffer) {
    return Failure(std::move(vertex_buffer.error()));
  }
  vertices = std::move(*vertex_buffer);
  std::ranges::copy(bytes, vertices->bytes().begin());
  auto uniform =
      HostBuffer::create(gpu.device(), VkDeviceSize{kParameterStride} * gpu.frames_in_flight(),
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  if (!uniform) {
    return Failure(std::move(uniform.error()));
  }
  parameters = std::move(*uniform);
  auto made = GpuTextures::create(gpu, scene);
  if (!made) {
    return Failure(std::move(made.error()));
  }
  textures = std::move(*made);
  for (const Material& material : scene.materials) {
    constants.push_back(draw_constants(material, *textures));
  }
  return {};
}

tl::expected<void, std::string> GbufferRenderer::State::create_layout() {
  const std::array<VkDescriptorSetLayoutBinding, 2> bindings{
      {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1,
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
       {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, texture_count(), VK_SHADER_STAGE_FRAGMENT_BIT,
        nullptr}}};
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = static_cast<uint32_t>(bindings.size()),
      .pBindings = bindings.data()};
  VkResult result = vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout);
  if (result != VK_SUCCESS) {
    return failure("the descriptor set layout", result);
  }
  const VkPushConstantRange range{kDrawStages, 0, sizeof(maths::GbufferDraw)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &range};
  result = vkCreatePipelineLayout(device, &info, nullptr, &layout);
  return result == VK_SUCCESS ? tl::expected<void, std::string>() : failure("the layout", result);
}

tl::expected<void, std::string> GbufferRenderer::State::create_set() {
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1},
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, texture_count()}}};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                             .pPoolSizes = sizes.data()};
  VkResult result = vkCreateDescriptorPool(device, &pool_info, nullptr, &pool);
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &set_layout};
  if (result == VK_SUCCESS) {
    result = vkAllocateDescriptorSets(device, &info, &set);
  }
  if (result != VK_SUCCESS) {
    return failure("the descriptor set", result);
  }
  const VkDescriptorBufferInfo buffer{parameters->buffer(), 0, sizeof(maths::GbufferParameters)};
  const std::vector<VkDescriptorImageInfo>& images = textures->descriptors();
  const std::array<VkWriteDescriptorSet, 2> writes{
      {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = 0,
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
        .pBufferInfo = &buffer},
       {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = 1,
        .descriptorCount = static_cast<uint32_t>(images.size()),
        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        .pImageInfo = images.data()}}};
  vkUpdateDescriptorSets(device, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  return {};
}

namespace {

// The state that never changes, as Vulkan wants it: attributes of Vertex, no blending.
struct FixedState {
  VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  std::array<VkVertexInputAttributeDescription, 6> attributes{
      {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position_ws)},
       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal_ws)},
       {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, face_normal_ws)},
       {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent_ws)},
       // Two sets of coordinates each.
       {4, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, base_color_uv)},
       {5, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, emissive_uv)}}};
  VkPipelineVertexInputStateCreateInfo vertices{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = 1,
      .pVertexBindingDescriptions = &binding,
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
  std::array<VkDynamicState, 3> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                               VK_DYNAMIC_STATE_CULL_MODE};
  VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = 3,
      .pDynamicStates = dynamic_states.data()};
  VkPipelineRenderingCreateInfo rendering{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = static_cast<uint32_t>(kColourFormats.size()),
      .pColorAttachmentFormats = kColourFormats.data(),
      .depthAttachmentFormat = kDepthFormat};

  FixedState() {
    for (auto& attachment : attachments) {
      attachment.colorWriteMask = 0xf;
    }
  }
  FixedState(const FixedState&) = delete;
  FixedState& operator=(const FixedState&) = delete;
};

}  // namespace

tl::expected<void, std::string> GbufferRenderer::State::create_pipeline(bool geometric_normals) {
  const std::array<uint32_t, 2> values{texture_count(), geometric_normals ? 1u : 0u};
  const std::array<VkSpecializationMapEntry, 2> entries{{{0, 0, 4}, {1, 4, 4}}};
  const VkSpecializationInfo specialisation{2, entries.data(), sizeof(values), values.data()};
  const ShaderStages stages(device, kGbufferVertex, kGbufferFragment, &specialisation);
  if (stages.result != VK_SUCCESS) {
    return failure("a shader", stages.result);
  }
  const FixedState fixed;
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
        .layout = layout};
    const VkResult result = vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr,
                                                      reversed ? &reversed_pipeline : &pipeline);
    if (result != VK_SUCCESS) {
      return failure("the pipeline", result);
    }
  }
  return {};
}

void GbufferRenderer::State::begin_rendering(RecordContext& context, const Gbuffer& gbuffer,
                                             bool reversed_z) const {
  std::array<VkRenderingAttachmentInfo, kColourFormats.size()> colours;
  const std::array targets{gbuffer.normal, gbuffer.albedo, gbuffer.motion, gbuffer.emissive};
  for (std::size_t i = 0; i < targets.size(); ++i) {
    // Without a view, what would be written is dropped.
    colours[i] = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                  .imageView = targets[i] ? context.view(targets[i]) : VkImageView{VK_NULL_HANDLE},
                  .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                  .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  }
  VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                  .imageView = context.view(gbuffer.depth),
                                  .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                  .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                  .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  depth.clearValue.depthStencil.depth = reversed_z ? 0.0f : 1.0f;
  const VkExtent3D size = context.extent(gbuffer.depth);
  const VkRect2D area{{0, 0}, {size.width, size.height}};
  const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                             .renderArea = area,
                             .layerCount = 1,
                             .colorAttachmentCount = static_cast<uint32_t>(colours.size()),
                             .pColorAttachments = colours.data(),
                             .pDepthAttachment = &depth};
  context.vk.vkCmdBeginRendering(context.commands, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(size.width), static_cast<float>(size.height), 0.0f, 1.0f};
  context.vk.vkCmdSetViewport(context.commands, 0, 1, &viewport);
  context.vk.vkCmdSetScissor(context.commands, 0, 1, &area);
}

void GbufferRenderer::State::record(RecordContext& context, const Gbuffer& gbuffer, bool reversed_z,
                                    std::uint32_t parameters_at, VkCullModeFlags culled) const {
  begin_rendering(context, gbuffer, reversed_z);
  const auto& vk = context.vk;
  vk.vkCmdSetCullMode(context.commands, culled);
  vk.vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                       reversed_z ? reversed_pipeline : pipeline);
  vk.vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set,
                             1, &parameters_at);
  const VkBuffer buffer = vertices->buffer();
  const VkDeviceSize offset = 0;
  vk.vkCmdBindVertexBuffers(context.commands, 0, 1, &buffer, &offset);
  for (const TriangleDraw& draw : draws) {
    maths::GbufferDraw pushed = constants[draw.material];
    pushed.moves = draw.moves ? 1 : 0;
    vk.vkCmdPushConstants(context.commands, layout, kDrawStages, 0, sizeof(pushed), &pushed);
    vk.vkCmdDraw(context.commands, draw.vertex_count, 1, draw.first_vertex, 0);
  }
  vk.vkCmdEndRendering(context.commands);
}

GbufferRenderer::GbufferRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GbufferRenderer::~GbufferRenderer() = default;

tl::expected<std::unique_ptr<GbufferRenderer>, std::string> GbufferRenderer::create(
    Gpu& gpu, const Scene& scene, bool geometric_normals) {
  auto state = std::make_unique<State>(gpu);
  auto done = state->upload(scene)
                  .and_then([&] { return state->create_layout(); })
                  .and_then([&] { return state->create_pipeline(geometric_normals); })
                  .and_then([&] { return state->create_set(); });
  if (!done) {
    return Failure(std::move(done.error()));
  }
  return std::unique_ptr<GbufferRenderer>(new GbufferRenderer(std::move(state)));
}

std::uint32_t GbufferRenderer::State::write_parameters(const GbufferView& view) {
  if (written == view) {
    return latest;
  }
  written = view;
  latest = (latest + kParameterStride) % (kParameterStride * gpu.frames_in_flight());
  maths::GbufferParameters frame;
  frame.clip_from_world = view.clip_from_view * view.view_from_world;
  frame.previous_clip_from_world = view.previous_clip_from_view * view.previous_view_from_world;
  frame.world_from_moving = view.world_from_moving;
  frame.previous_world_from_moving = view.previous_world_from_moving;
  const glm::mat4 world_from_view = glm::inverse(view.view_from_world);
  const bool perspective = view.clip_from_view[2][3] != 0.0f;
  frame.eye_ws = perspective ? glm::vec4(glm::vec3(world_from_view[3]), 1.0f)
                             : glm::vec4(glm::vec3(world_from_view[2]), 0.0f);
  std::memcpy(parameters->bytes().data() + latest, &frame, sizeof(frame));
  return latest;
}

Gbuffer GbufferRenderer::add(Graph& graph, const GbufferView& view, const Gbuffer& targets) {
  const std::uint32_t at = state_->write_parameters(view);
  Gbuffer gbuffer = targets;
  auto pass = graph.add_pass("g-buffer");
  gbuffer.depth = pass.write(targets.depth, framegraph::access::depth_attachment, {},
                             framegraph::Contents::discard);
  for (Texture* target : {&gbuffer.normal, &gbuffer.albedo, &gbuffer.motion, &gbuffer.emissive}) {
    if (*target) {
      *target = pass.write(*target, framegraph::access::color_attachment, {},
                           framegraph::Contents::discard);
    }
  }
  pass.record(
      [state = state_.get(), gbuffer, reversed = view.reversed_z, at](RecordContext& context) {
        state->record(context, gbuffer, reversed, at, VK_CULL_MODE_NONE);
      });
  return gbuffer;
}

Texture GbufferRenderer::add_back_faces(Graph& graph, const GbufferView& view, Texture depth) {
  const std::uint32_t at = state_->write_parameters(view);
  auto pass = graph.add_pass("back faces");
  depth =
      pass.write(depth, framegraph::access::depth_attachment, {}, framegraph::Contents::discard);
  pass.record(
      [state = state_.get(), depth, reversed = view.reversed_z, at](RecordContext& context) {
        state->record(context, {.depth = depth}, reversed, at, VK_CULL_MODE_FRONT_BIT);
      });
  return depth;
}

}  // namespace alcove::sample
