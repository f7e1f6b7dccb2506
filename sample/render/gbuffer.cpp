#include "render/gbuffer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "render/gbuffer_pipelines.h"
#include "render/gpu_textures.h"
#include "render/shaders/gbuffer.h"
#include "render/triangles.h"

namespace alcove::sample {
namespace {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using Failure = tl::unexpected<std::string>;

// From one frame's parameters to the next's: a multiple of the largest alignment that a device may
// ask for.
constexpr std::uint32_t kParameterStride = 512;
static_assert(sizeof(maths::GbufferParameters) <= kParameterStride && kParameterStride % 256 == 0);

maths::GbufferDraw draw_constants(const Material& material) {
  maths::GbufferDraw draw{};
  draw.base_colour = material.base_color;
  draw.emissive = glm::vec4(material.emissive, 0.0f);
  draw.metallic = material.metallic;
  draw.roughness = material.roughness;
  if (material.alpha_mode == AlphaMode::kMask) {
    draw.alpha_cutoff = material.alpha_cutoff;
  }
  draw.has_normal_map = material.normal_texture.image >= 0 ? 1 : 0;
  draw.normal_scale = material.normal_scale;
  return draw;
}

}  // namespace

struct GbufferRenderer::State {
  // How the scene is drawn.
  struct Drawing {
    bool reversed_z = false;
    std::uint32_t parameters_at = 0;
    VkCullModeFlags culled = VK_CULL_MODE_NONE;
    Texture first;  // depth of what is left out, with what lies before it; null: nothing is
  };
  explicit State(Gpu& owner) : gpu(owner), device(owner.device().device()) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();

  tl::expected<void, std::string> upload(const Scene& scene);
  tl::expected<void, std::string> create_sets(const Scene& scene);
  void write_sets(const Scene& scene) const;
  // Returns where in the parameters those of the view are.
  std::uint32_t write_parameters(const GbufferView& view);
  void record(RecordContext& context, const Gbuffer& gbuffer, const Drawing& drawing) const;
  void bind_first_layer(RecordContext& context, Texture depth) const;
  void begin_rendering(RecordContext& context, const Gbuffer& gbuffer, bool reversed_z) const;

  Gpu& gpu;
  VkDevice device;
  std::vector<TriangleDraw> draws;
  std::vector<maths::GbufferDraw> constants;  // by material
  std::unique_ptr<HostBuffer> vertices;
  std::unique_ptr<HostBuffer> parameters;  // one for each frame in flight
  std::optional<GbufferView> written;      // the latest of them
  std::uint32_t latest = 0;                // where it is
  std::unique_ptr<GpuTextures> textures;
  std::unique_ptr<GbufferPipelines> pipelines;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet frame_set = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> layer_sets;  // one for each frame in flight
  std::vector<VkDescriptorSet> material_sets;
};

GbufferRenderer::State::~State() { vkDestroyDescriptorPool(device, pool, nullptr); }

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
    constants.push_back(draw_constants(material));
  }
  return {};
}

tl::expected<void, std::string> GbufferRenderer::State::create_sets(const Scene& scene) {
  const uint32_t frames = gpu.frames_in_flight();
  const auto materials = static_cast<uint32_t>(scene.materials.size());
  const std::array<VkDescriptorPoolSize, 3> sizes{
      {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1},
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        maths::kMaterialTextures * std::max(materials, 1u)},
       {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, frames}}};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1 + frames + materials,
                                             .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                             .pPoolSizes = sizes.data()};
  VkResult result = vkCreateDescriptorPool(device, &pool_info, nullptr, &pool);
  const auto allocate = [&](VkDescriptorSetLayout layout, VkDescriptorSet& made) {
    const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = pool,
                                           .descriptorSetCount = 1,
                                           .pSetLayouts = &layout};
    if (result == VK_SUCCESS) {
      result = vkAllocateDescriptorSets(device, &info, &made);
    }
  };
  allocate(pipelines->frame_set(), frame_set);
  layer_sets.resize(frames);
  for (VkDescriptorSet& layer : layer_sets) {
    allocate(pipelines->layer_set(), layer);
  }
  material_sets.resize(materials);
  for (VkDescriptorSet& material : material_sets) {
    allocate(pipelines->material_set(), material);
  }
  if (result != VK_SUCCESS) {
    return device_failure("create the descriptor sets of the g-buffer", result);
  }
  write_sets(scene);
  return {};
}

void GbufferRenderer::State::write_sets(const Scene& scene) const {
  const VkDescriptorBufferInfo buffer{parameters->buffer(), 0, sizeof(maths::GbufferParameters)};
  const VkWriteDescriptorSet frame{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = frame_set,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
                                   .pBufferInfo = &buffer};
  vkUpdateDescriptorSets(device, 1, &frame, 0, nullptr);
  for (std::size_t i = 0; i < material_sets.size(); ++i) {
    const auto images = textures->descriptors_of(scene.materials[i]);
    const VkWriteDescriptorSet material{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = material_sets[i],
                                        .descriptorCount = static_cast<uint32_t>(images.size()),
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = images.data()};
    vkUpdateDescriptorSets(device, 1, &material, 0, nullptr);
  }
}

void GbufferRenderer::State::begin_rendering(RecordContext& context, const Gbuffer& gbuffer,
                                             bool reversed_z) const {
  const std::array targets{gbuffer.normal, gbuffer.albedo, gbuffer.motion, gbuffer.emissive};
  std::array<VkRenderingAttachmentInfo, std::tuple_size_v<decltype(targets)>> colours;
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

void GbufferRenderer::State::bind_first_layer(RecordContext& context, Texture depth) const {
  const VkDescriptorSet layer = layer_sets[context.frame_slot];
  const VkDescriptorImageInfo image{.imageView = context.view(depth),
                                    .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = layer,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                   .pImageInfo = &image};
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  context.vk.vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                     pipelines->layout(), 1, 1, &layer, 0, nullptr);
}

void GbufferRenderer::State::record(RecordContext& context, const Gbuffer& gbuffer,
                                    const Drawing& drawing) const {
  begin_rendering(context, gbuffer, drawing.reversed_z);
  using Kind = GbufferPipelines::Kind;
  const Kind kind = drawing.first ? Kind::second_layer : Kind::all;
  const auto& vk = context.vk;
  vk.vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                       pipelines->pipeline(kind, drawing.reversed_z));
  const VkPipelineLayout layout = pipelines->layout();
  vk.vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1,
                             &frame_set, 1, &drawing.parameters_at);
  if (drawing.first) {
    bind_first_layer(context, drawing.first);
  }
  const VkBuffer buffer = vertices->buffer();
  const VkDeviceSize offset = 0;
  vk.vkCmdBindVertexBuffers(context.commands, 0, 1, &buffer, &offset);
  vk.vkCmdSetCullMode(context.commands, drawing.culled);
  for (const TriangleDraw& draw : draws) {
    vk.vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1,
                               &material_sets[draw.material], 0, nullptr);
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
  if (auto done = state->upload(scene); !done) {
    return Failure(std::move(done.error()));
  }
  auto pipelines = GbufferPipelines::create(state->device, geometric_normals);
  if (!pipelines) {
    return Failure(std::move(pipelines.error()));
  }
  state->pipelines = std::move(*pipelines);
  if (auto done = state->create_sets(scene); !done) {
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
  frame.depth_unproject = {-view.clip_from_view[3][3], view.clip_from_view[3][2],
                           -view.clip_from_view[2][3], view.clip_from_view[2][2]};
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
        state->record(context, gbuffer, {reversed, at});
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
        state->record(context, {.depth = depth}, {reversed, at, VK_CULL_MODE_FRONT_BIT});
      });
  return depth;
}

Texture GbufferRenderer::add_second_layer(Graph& graph, const GbufferView& view, Texture first,
                                          Texture depth) {
  const std::uint32_t at = state_->write_parameters(view);
  auto pass = graph.add_pass("second layer");
  pass.read(first, framegraph::access::sampled_fragment);
  depth =
      pass.write(depth, framegraph::access::depth_attachment, {}, framegraph::Contents::discard);
  pass.record(
      [state = state_.get(), first, depth, reversed = view.reversed_z, at](RecordContext& context) {
        state->record(context, {.depth = depth}, {reversed, at, VK_CULL_MODE_BACK_BIT, first});
      });
  return depth;
}

}  // namespace alcove::sample
