#include "render/gbuffer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "render/gbuffer_pipelines.h"
#include "render/gpu_meshes.h"
#include "render/gpu_textures.h"
#include "render/shaders/gbuffer.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The distances in bytes, within their buffers, between the parameters of two frames and between
// those of two materials: multiples of 256, the largest alignment that a device may require.
constexpr std::uint32_t kParameterStride = 512;
constexpr std::uint32_t kMaterialStride = 256;
static_assert(sizeof(maths::GbufferParameters) <= kParameterStride && kParameterStride % 256 == 0);
static_assert(sizeof(maths::GbufferMaterial) <= kMaterialStride && kMaterialStride % 256 == 0);

void set_uv_rows(maths::GbufferMaterial& out, std::uint32_t lookup, const TextureUse& use) {
  const glm::mat3x2& m = use.texture_from_mesh_uv;
  for (int row = 0; row < 2; ++row) {
    out.uv_rows[2 * lookup + static_cast<std::uint32_t>(row)] = {
        m[0][row], m[1][row], m[2][row], row == 0 ? static_cast<float>(use.uv_set) : 0.0f};
  }
}

maths::GbufferMaterial parameters_of(const Material& material) {
  maths::GbufferMaterial out{};
  out.base_colour = material.base_color;
  out.emissive = glm::vec4(material.emissive, 0.0f);
  out.metallic = material.metallic;
  out.roughness = material.roughness;
  if (material.alpha_mode == AlphaMode::kMask) {
    out.alpha_cutoff = material.alpha_cutoff;
  }
  out.has_normal_map = material.normal_texture.image >= 0 ? 1 : 0;
  out.normal_scale = material.normal_scale;
  set_uv_rows(out, maths::kBaseColourUv, material.base_color_texture);
  set_uv_rows(out, maths::kMetallicRoughnessUv, material.metal_roughness_texture);
  set_uv_rows(out, maths::kEmissiveUv, material.emissive_texture);
  set_uv_rows(out, maths::kNormalUv, material.normal_texture);
  return out;
}

}  // namespace

struct GbufferRenderer::State {
  // The state with which the scene is drawn in one pass.
  struct Drawing {
    bool reversed_z = false;
    std::uint32_t parameters_at = 0;
    VkCullModeFlags culled = VK_CULL_MODE_BACK_BIT;     // of single-sided materials
    VkCullModeFlags double_culled = VK_CULL_MODE_NONE;  // of double-sided ones
    // Depth of the first layer, which the pass of the second layer reads; may be null.
    Texture first;
  };
  explicit State(Gpu& owner) : gpu(owner), device(owner.device().device()) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();

  tl::expected<void, std::string> upload(const Scene& scene);
  tl::expected<void, std::string> create_sets(const Scene& scene);
  void write_sets(const Scene& scene) const;
  // Writes the parameters of a view, and returns their offset in the parameter buffer.
  std::uint32_t write_parameters(const GbufferView& view);
  void record(RecordContext& context, const Gbuffer& gbuffer, const Drawing& drawing) const;
  void bind_first_layer(RecordContext& context, Texture depth) const;
  void begin_rendering(RecordContext& context, const Gbuffer& gbuffer, bool reversed_z) const;

  Gpu& gpu;
  VkDevice device;
  std::vector<bool> double_sided;  // by material
  std::unique_ptr<GpuMeshes> meshes;
  std::unique_ptr<HostBuffer> materials;   // GbufferMaterial at multiples of kMaterialStride
  std::unique_ptr<HostBuffer> parameters;  // one set of parameters for each frame in flight
  std::optional<GbufferView> written;      // the view that was written most recently
  std::uint32_t latest = 0;                // offset of its parameters
  std::unique_ptr<GpuTextures> textures;
  std::unique_ptr<GbufferPipelines> pipelines;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet frame_set = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> layer_sets;  // one for each frame in flight
  std::vector<VkDescriptorSet> material_sets;
};

GbufferRenderer::State::~State() { vkDestroyDescriptorPool(device, pool, nullptr); }

tl::expected<void, std::string> GbufferRenderer::State::upload(const Scene& scene) {
  auto uploaded = GpuMeshes::create(gpu.device(), scene);
  if (!uploaded) {
    return Failure(std::move(uploaded.error()));
  }
  meshes = std::move(*uploaded);
  auto constants = HostBuffer::create(
      gpu.device(),
      VkDeviceSize{kMaterialStride} * std::max<std::size_t>(scene.materials.size(), 1),
      VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  if (!constants) {
    return Failure(std::move(constants.error()));
  }
  materials = std::move(*constants);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const maths::GbufferMaterial material = parameters_of(scene.materials[i]);
    std::memcpy(materials->bytes().data() + i * kMaterialStride, &material, sizeof(material));
    double_sided.push_back(scene.materials[i].double_sided);
  }
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
  return {};
}

tl::expected<void, std::string> GbufferRenderer::State::create_sets(const Scene& scene) {
  const uint32_t frames = gpu.frames_in_flight();
  const auto count = static_cast<uint32_t>(scene.materials.size());
  const std::array<VkDescriptorPoolSize, 4> sizes{
      {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1},
       {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, std::max(count, 1u)},
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, maths::kMaterialTextures * std::max(count, 1u)},
       {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, frames}}};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1 + frames + count,
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
  material_sets.resize(count);
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
    const VkDescriptorBufferInfo constants{materials->buffer(), i * VkDeviceSize{kMaterialStride},
                                           sizeof(maths::GbufferMaterial)};
    const std::array<VkWriteDescriptorSet, 2> writes{
        {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = material_sets[i],
          .dstBinding = 0,
          .descriptorCount = static_cast<uint32_t>(images.size()),
          .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
          .pImageInfo = images.data()},
         {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = material_sets[i],
          .dstBinding = 1,
          .descriptorCount = 1,
          .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
          .pBufferInfo = &constants}}};
    vkUpdateDescriptorSets(device, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  }
}

void GbufferRenderer::State::begin_rendering(RecordContext& context, const Gbuffer& gbuffer,
                                             bool reversed_z) const {
  const std::array targets{gbuffer.normal, gbuffer.albedo, gbuffer.motion, gbuffer.emissive};
  std::array<VkRenderingAttachmentInfo, std::tuple_size_v<decltype(targets)>> colours;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    // An attachment without a view discards what the shader writes to it.
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
  vkCmdBeginRendering(context.commands, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(size.width), static_cast<float>(size.height), 0.0f, 1.0f};
  vkCmdSetViewport(context.commands, 0, 1, &viewport);
  vkCmdSetScissor(context.commands, 0, 1, &area);
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
  vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines->layout(), 1,
                          1, &layer, 0, nullptr);
}

void GbufferRenderer::State::record(RecordContext& context, const Gbuffer& gbuffer,
                                    const Drawing& drawing) const {
  begin_rendering(context, gbuffer, drawing.reversed_z);
  using Kind = GbufferPipelines::Kind;
  const Kind kind = drawing.first ? Kind::second_layer : Kind::all;
  vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                    pipelines->pipeline(kind, drawing.reversed_z));
  const VkPipelineLayout layout = pipelines->layout();
  vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1,
                          &frame_set, 1, &drawing.parameters_at);
  if (drawing.first) {
    bind_first_layer(context, drawing.first);
  }
  std::optional<std::uint32_t> bound_material;
  for (const MeshDraw& draw : meshes->draws()) {
    if (bound_material != draw.material) {
      vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1,
                              &material_sets[draw.material], 0, nullptr);
      bound_material = draw.material;
    }
    const maths::GbufferDraw pushed{draw.moves ? 1u : 0u, draw.faceted ? 1u : 0u};
    vkCmdPushConstants(context.commands, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(pushed),
                       &pushed);
    vkCmdSetCullMode(context.commands,
                     double_sided[draw.material] ? drawing.double_culled : drawing.culled);
    vkCmdSetFrontFace(context.commands,
                      draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdBindVertexBuffers2(context.commands, 0, kVertexStreams, draw.buffers.data(),
                            draw.offsets.data(), nullptr, draw.strides.data());
    vkCmdBindIndexBuffer(context.commands, draw.index_buffer, draw.index_offset,
                         VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(context.commands, draw.index_count, draw.instance_count, 0, 0, 0);
  }
  vkCmdEndRendering(context.commands);
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
        state->record(context, {.depth = depth},
                      {reversed, at, VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_FRONT_BIT});
      });
  return depth;
}

// Culls the back faces of double-sided materials too. Exporters often mark closed solids as
// double-sided. If their back faces were drawn, the second layer of a pixel would usually be the
// back of the first solid, which says nothing about the surfaces behind it. The disadvantage: a
// thin double-sided surface, such as a leaf, that is seen from behind is missing in the second
// layer, so that it does not occlude there.
Texture GbufferRenderer::add_second_layer(Graph& graph, const GbufferView& view, Texture first,
                                          Texture depth) {
  const std::uint32_t at = state_->write_parameters(view);
  auto pass = graph.add_pass("second layer");
  pass.read(first, framegraph::access::sampled_fragment);
  depth =
      pass.write(depth, framegraph::access::depth_attachment, {}, framegraph::Contents::discard);
  pass.record(
      [state = state_.get(), first, depth, reversed = view.reversed_z, at](RecordContext& context) {
        state->record(context, {.depth = depth},
                      {reversed, at, VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_BACK_BIT, first});
      });
  return depth;
}

}  // namespace alcove::sample
