#include "render/gbuffer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "gpu/occlusion.h"
#include "render/shaders/gbuffer.h"
#include "spirv/depth_fragment.h"
#include "spirv/depth_vertex.h"
#include "spirv/gbuffer_fragment.h"
#include "spirv/gbuffer_vertex.h"
#include "spirv/second_layer.h"

namespace alcove::sample {
namespace {

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

maths::GbufferMaterial convert(const Material& material) {
  maths::GbufferMaterial out{};
  out.base_colour = material.base_color;
  out.emissive = glm::vec4(material.emissive, 0.0f);
  out.metallic = material.metallic;
  out.roughness = material.roughness;
  if (material.alpha_mode == AlphaMode::mask) out.least_alpha = material.least_alpha();
  out.has_normal_map = material.normal_texture.image >= 0 ? 1 : 0;
  out.normal_scale = material.normal_scale;
  set_uv_rows(out, maths::kBaseColourUv, material.base_color_texture);
  set_uv_rows(out, maths::kMetallicRoughnessUv, material.metal_roughness_texture);
  set_uv_rows(out, maths::kEmissiveUv, material.emissive_texture);
  set_uv_rows(out, maths::kNormalUv, material.normal_texture);
  return out;
}

constexpr std::span<const GbufferTarget> kColours(kGbufferTargets.begin() + 1, 4);
constexpr std::array<VkFormat, 4> kColourFormats{kNormalFormat, kAlbedoFormat, kMotionFormat,
                                                 kEmissiveFormat};

// The indices of the pipelines; the next index is the pipeline for reversed depth.
enum PipelineIndex : std::size_t { kColoursAndDepth = 0, kDepthOnly = 2, kSecondDepth = 4 };

// The numbers of the descriptor sets. Each material has a set of its own, because few devices allow
// hundreds of textures in one set.
constexpr std::uint32_t kFrameSet = 0;     // the parameters of the frame, with a dynamic offset
constexpr std::uint32_t kLayerSet = 1;     // only of the second layer: the depth of the first one
constexpr std::uint32_t kMaterialSet = 2;  // the textures and the parameters of a material

// Locations are those of shaders/gbuffer_vertex.h. The attributes that drawing only depth needs
// come first.
constexpr VkVertexInputAttributeDescription attribute(std::uint32_t location, VertexStream stream,
                                                      VkFormat format, std::uint32_t offset = 0) {
  return {location, static_cast<std::uint32_t>(stream), format, offset};
}
constexpr std::array kAttributes{
    attribute(0, VertexStream::position, VK_FORMAT_R32G32B32_SFLOAT),
    attribute(2, VertexStream::uv, VK_FORMAT_R32G32_SFLOAT),
    attribute(3, VertexStream::second_uv, VK_FORMAT_R32G32_SFLOAT),
    attribute(5, VertexStream::color, VK_FORMAT_R8G8B8A8_UNORM),
    attribute(6, VertexStream::instance, VK_FORMAT_R32G32B32A32_SFLOAT),
    attribute(7, VertexStream::instance, VK_FORMAT_R32G32B32A32_SFLOAT, 16),
    attribute(8, VertexStream::instance, VK_FORMAT_R32G32B32A32_SFLOAT, 32),
    attribute(1, VertexStream::normals, VK_FORMAT_R16G16B16A16_SNORM),
    attribute(4, VertexStream::tangent, VK_FORMAT_R16G16B16A16_SNORM)};
constexpr std::size_t kDepthAttributes = 7;

}  // namespace

GbufferView gbuffer_view(const Camera& now, const Camera& before, VkExtent2D size) {
  const CameraMatrices matrices = camera_matrices(now, size.width, size.height);
  const CameraMatrices previous = camera_matrices(before, size.width, size.height);
  return {matrices.view_from_world, matrices.clip_from_view, previous.view_from_world,
          previous.clip_from_view, now.reversed_z};
}

std::uint32_t guard_band_pixels(double percent, std::uint32_t height) {
  return 2 * static_cast<std::uint32_t>(0.005 * percent * height);
}

GbufferView with_guard_band(GbufferView view, VkExtent2D size, VkExtent2D band) {
  const glm::vec2 shown(size.width, size.height);
  const glm::vec4 scale(shown / (shown + 2.0f * glm::vec2(band.width, band.height)), 1.0f, 1.0f);
  for (glm::mat4* clip_from_view : {&view.clip_from_view, &view.previous_clip_from_view})
    for (int column = 0; column < 4; ++column) (*clip_from_view)[column] *= scale;
  return view;
}

Result<void> GbufferRenderer::upload(const Scene& scene) {
  const VulkanDevice& device = gpu_.device();
  const auto uniform = [&](std::size_t stride, std::size_t count) {
    return HostBuffer::create(device, VkDeviceSize{stride} * std::max<std::size_t>(count, 1),
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  };
  ALCOVE_TRY(meshes_, GpuMeshes::create(device, scene));
  ALCOVE_TRY(materials_, uniform(kMaterialStride, scene.materials.size()));
  ALCOVE_TRY(parameters_, uniform(kParameterStride, gpu_.frames_in_flight()));
  ALCOVE_TRY(textures_, GpuTextures::create(gpu_, scene));
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const maths::GbufferMaterial material = convert(scene.materials[i]);
    std::memcpy(materials_->bytes().data() + i * kMaterialStride, &material, sizeof(material));
    double_sided_.push_back(scene.materials[i].double_sided);
  }
  return {};
}

VkResult GbufferRenderer::create_layout(const Scene& scene) {
  constexpr VkShaderStageFlags kBoth = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  constexpr VkDescriptorType kImages = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  constexpr VkDescriptorType kParameters = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
  const auto count = static_cast<std::uint32_t>(scene.materials.size());
  const SetDescription sets[] = {
      {{{kParameters, kBoth}}, 1},
      {{{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, gpu_.frames_in_flight()},
      {{{kImages, VK_SHADER_STAGE_FRAGMENT_BIT, maths::kMaterialTextures},
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kBoth}},
       count}};
  const VkResult result =
      layout_.create(sets, {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(maths::GbufferDraw)});
  if (result != VK_SUCCESS) return result;
  const VkDescriptorBufferInfo frame{parameters_->buffer(), 0, sizeof(maths::GbufferParameters)};
  layout_.write(layout_.set(kFrameSet, 0), 0, kParameters, {}, &frame);
  for (std::size_t i = 0; i < count; ++i) {
    const VkDescriptorSet set = layout_.set(kMaterialSet, i);
    const VkDescriptorBufferInfo constants{materials_->buffer(), i * VkDeviceSize{kMaterialStride},
                                           sizeof(maths::GbufferMaterial)};
    layout_.write(set, 0, kImages, textures_->descriptors_of(scene.materials[i]));
    layout_.write(set, 1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {}, &constants);
  }
  return VK_SUCCESS;
}

VkResult GbufferRenderer::create_pipelines(std::size_t first_index, bool geometric_normals) {
  const std::uint32_t geometric = geometric_normals ? 1 : 0;
  const VkSpecializationMapEntry entry{0, 0, sizeof geometric};
  const VkSpecializationInfo specialisation{1, &entry, sizeof geometric, &geometric};
  std::array<VkVertexInputBindingDescription, kVertexStreams> streams{};
  for (std::uint32_t i = 0; i < kVertexStreams; ++i) {
    streams[i] = {i, 0,
                  i == static_cast<std::uint32_t>(VertexStream::instance)
                      ? VK_VERTEX_INPUT_RATE_INSTANCE
                      : VK_VERTEX_INPUT_RATE_VERTEX};
  }
  PipelineDescription description{
      .vertex_code = kGbufferVertex,
      .fragment_code = kGbufferFragment,
      .fragment_constants = &specialisation,
      .streams = streams,
      .attributes = kAttributes,
      .colour_formats = kColourFormats,
      .depth_format = kDepthFormat,
      .dynamic_states = {VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE,
                         VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE},
      .layout = layout_.handle()};
  if (first_index != kColoursAndDepth) {
    description.vertex_code = kDepthVertex;
    description.fragment_code = kDepthFragment;
    if (first_index == kSecondDepth) description.fragment_code = kSecondLayer;
    description.fragment_constants = nullptr;
    description.attributes = description.attributes.first(kDepthAttributes);
    description.colour_formats = {};
  }
  VkPipeline* const made = &pipelines_[first_index];
  const VkResult result = create_pipeline(gpu_.device().device(), description, made[0]);
  description.depth_compare = VK_COMPARE_OP_GREATER;
  return result == VK_SUCCESS ? create_pipeline(gpu_.device().device(), description, made[1])
                              : result;
}

GbufferRenderer::~GbufferRenderer() {
  for (const VkPipeline pipeline : pipelines_)
    vkDestroyPipeline(gpu_.device().device(), pipeline, nullptr);
}

void GbufferRenderer::record(RecordContext& context, const Gbuffer& gbuffer,
                             const Drawing& drawing) const {
  const VkCommandBuffer commands = context.commands;
  const VkClearValue black{};
  const VkClearValue farthest{.depthStencil = {drawing.reversed_z ? 0.0f : 1.0f, 0}};
  const framegraph::Attachment colours[] = {{gbuffer.normal, &black},
                                            {gbuffer.albedo, &black},
                                            {gbuffer.motion, &black},
                                            {gbuffer.emissive, &black}};
  const bool coloured{gbuffer.normal};
  begin_rendering(context, std::span(colours).first(coloured ? std::size(colours) : 0),
                  {gbuffer.depth, &farthest});
  const std::size_t pipeline = coloured        ? kColoursAndDepth
                               : drawing.first ? kSecondDepth
                                               : kDepthOnly;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                    pipelines_[pipeline + (drawing.reversed_z ? 1 : 0)]);
  layout_.bind(commands, kFrameSet, layout_.set(kFrameSet, 0), {&drawing.parameters_offset, 1});
  if (drawing.first) {
    const VkDescriptorSet set = layout_.set(kLayerSet, context.frame_slot);
    const VkDescriptorImageInfo image{.imageView = context.view(drawing.first),
                                      .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    layout_.write(set, 0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, {&image, 1});
    layout_.bind(commands, kLayerSet, set);
  }
  std::optional<std::uint32_t> bound_material;
  for (const MeshDraw& draw : meshes_->draws()) {
    if (bound_material != draw.material) {
      layout_.bind(commands, kMaterialSet, layout_.set(kMaterialSet, draw.material));
      bound_material = draw.material;
    }
    const maths::GbufferDraw pushed{draw.moves ? 1u : 0u, draw.faceted ? 1u : 0u};
    vkCmdPushConstants(commands, layout_.handle(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(pushed),
                       &pushed);
    vkCmdSetCullMode(commands,
                     double_sided_[draw.material] ? drawing.double_culled : drawing.culled);
    vkCmdSetFrontFace(commands,
                      draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdBindVertexBuffers2(commands, 0, kVertexStreams, draw.buffers.data(), draw.offsets.data(),
                            nullptr, draw.strides.data());
    vkCmdBindIndexBuffer(commands, draw.index_buffer, draw.index_offset, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, draw.index_count, draw.instance_count, 0, 0, 0);
  }
  vkCmdEndRendering(commands);
}

Result<std::unique_ptr<GbufferRenderer>> GbufferRenderer::create(Gpu& gpu, const Scene& scene,
                                                                 bool geometric_normals) {
  std::unique_ptr<GbufferRenderer> made(new GbufferRenderer(gpu));
  ALCOVE_TRY_VOID(made->upload(scene));
  VkResult result = made->create_layout(scene);
  for (const std::size_t first_index : {kColoursAndDepth, kDepthOnly, kSecondDepth})
    if (result == VK_SUCCESS) result = made->create_pipelines(first_index, geometric_normals);
  if (result != VK_SUCCESS) return device_failure("create the pipelines of the g-buffer", result);
  return made;
}

std::uint32_t GbufferRenderer::write_parameters(const GbufferView& view) {
  if (written_ == view) return latest_;
  written_ = view;
  latest_ = (latest_ + kParameterStride) % (kParameterStride * gpu_.frames_in_flight());
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
  std::memcpy(parameters_->bytes().data() + latest_, &frame, sizeof(frame));
  return latest_;
}

// The second layer culls the back faces of double-sided materials too. Exporters often mark closed
// solids as double-sided. If their back faces were drawn, the second layer of a pixel would usually
// be the back of the first solid, which says nothing about the surfaces behind it. The
// disadvantage: a thin double-sided surface, such as a leaf, that is seen from behind is missing in
// the second layer, so that it does not occlude there.
Gbuffer GbufferRenderer::add(Graph& graph, const GbufferView& view, const Gbuffer& targets) {
  Drawing drawing{view.reversed_z, write_parameters(view)};
  Gbuffer drawn = targets;
  const auto is_wanted = [&](const GbufferTarget& colour) { return bool{targets.*colour.texture}; };
  // The fragment shader writes all colours, and Vulkan wants an attachment for each of them.
  for (const GbufferTarget& colour : kColours)
    if (!is_wanted(colour) && std::ranges::any_of(kColours, is_wanted))
      drawn.*colour.texture =
          graph.create_texture(colour.name, {colour.format, extent_of(graph, targets.depth)});
  drawn = add_pass(graph, "g-buffer", drawn, drawing);
  for (const GbufferTarget& colour : kColours)
    if (!is_wanted(colour)) drawn.*colour.texture = {};
  if (targets.back_depth) {
    drawing.culled = drawing.double_culled = VK_CULL_MODE_FRONT_BIT;
    drawn.back_depth = add_pass(graph, "back faces", {.depth = targets.back_depth}, drawing).depth;
  }
  if (targets.second_depth) {
    drawing.culled = drawing.double_culled = VK_CULL_MODE_BACK_BIT;
    drawing.first = drawn.depth;
    drawn.second_depth =
        add_pass(graph, "second layer", {.depth = targets.second_depth}, drawing).depth;
  }
  return drawn;
}

Gbuffer GbufferRenderer::add_pass(Graph& graph, const char* name, Gbuffer drawn,
                                  const Drawing& drawing) {
  auto pass = graph.add_pass(name);
  const auto write = [&](Texture& texture, const framegraph::Access& access) {
    if (texture) texture = pass.write(texture, access, {}, framegraph::Contents::discard);
  };
  if (drawing.first) pass.read(drawing.first, framegraph::access::sampled_fragment);
  write(drawn.depth, framegraph::access::depth_attachment);
  for (const GbufferTarget& colour : kColours)
    write(drawn.*colour.texture, framegraph::access::color_attachment);
  pass.record([this, drawn, drawing](RecordContext& context) { record(context, drawn, drawing); });
  return drawn;
}

}  // namespace alcove::sample
