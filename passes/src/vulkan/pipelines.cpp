#include "alcove/passes/pipelines.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "vulkan/pipeline_state.h"
#include "vulkan/vulkan_error.h"

namespace alcove::passes {
namespace {

const ShaderInterface& interface_of(std::size_t shader) {
  return shader_interface(static_cast<Shader>(shader));
}

}  // namespace

Pipelines::State::~State() {
  if (device() == VK_NULL_HANDLE) return;
  for (const CachedPipeline& pipeline : cached)
    vk.vkDestroyPipeline(device(), pipeline.pipeline, callbacks());
  for (const ShaderObjects& shader : shaders) {
    vk.vkDestroyShaderModule(device(), shader.module, callbacks());
    vk.vkDestroyPipelineLayout(device(), shader.pipeline_layout, callbacks());
    vk.vkDestroyDescriptorSetLayout(device(), shader.set_layout, callbacks());
  }
  vk.vkDestroySampler(device(), sampler, callbacks());
}

// Checks the device limit on storage images per stage. It is the only descriptor limit that the
// shaders may exceed: Vulkan guarantees only 4.
tl::expected<void, Error> Pipelines::State::check_limits() const {
  VkPhysicalDeviceProperties properties{};
  vk.vkGetPhysicalDeviceProperties(handles.physical_device, &properties);
  const std::uint32_t limit = properties.limits.maxPerStageDescriptorStorageImages;
  std::ptrdiff_t needed = 0;
  for (std::size_t shader = 0; shader < kShaderCount; ++shader) {
    needed = std::max(
        needed, std::ranges::count(interface_of(shader).bindings, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                   &ShaderBinding::type));
  }
  if (limit >= static_cast<std::size_t>(needed)) return {};
  return tl::unexpected(Error{"The device '" + std::string(properties.deviceName) +
                                  "' binds at most " + std::to_string(limit) +
                                  " storage images to a shader; the occlusion passes need " +
                                  std::to_string(needed) + ".",
                              ALCOVE_ERROR_UNSUPPORTED});
}

tl::expected<void, Error> Pipelines::State::create_sampler() {
  // The filters are those whose value is 0: nearest.
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  if (const VkResult result = vk.vkCreateSampler(device(), &info, callbacks(), &sampler);
      result != VK_SUCCESS)
    return creation_error("a sampler", result);
  return {};
}

tl::expected<void, Error> Pipelines::State::create_layout(std::size_t shader) {
  const std::span<const ShaderBinding> bindings = interface_of(shader).bindings;
  std::array<VkDescriptorSetLayoutBinding, kMaxBindings> described{};
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const bool samples = bindings[i].type == VK_DESCRIPTOR_TYPE_SAMPLER;
    described.at(i) = {bindings[i].number, bindings[i].type, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                       samples ? &sampler : nullptr};
  }
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = static_cast<std::uint32_t>(bindings.size()),
      .pBindings = described.data()};
  ShaderObjects& objects = shaders[shader];
  if (const VkResult result =
          vk.vkCreateDescriptorSetLayout(device(), &set_info, callbacks(), &objects.set_layout);
      result != VK_SUCCESS)
    return creation_error("a descriptor set layout", result);
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &objects.set_layout};
  if (const VkResult result =
          vk.vkCreatePipelineLayout(device(), &info, callbacks(), &objects.pipeline_layout);
      result != VK_SUCCESS)
    return creation_error("a pipeline layout", result);
  return {};
}

tl::expected<void, Error> Pipelines::State::create_layouts() {
  tl::expected<void, Error> done;
  for (std::size_t shader = 0; done && shader < kShaderCount; ++shader)
    done = create_layout(shader);
  return done;
}

tl::expected<void, Error> Pipelines::State::create_sets(std::uint32_t slot_count) {
  auto descriptor_sets = DescriptorSets::create(vk, handles, slot_count);
  if (!descriptor_sets) return tl::unexpected(std::move(descriptor_sets.error()));
  sets = std::move(*descriptor_sets);
  return {};
}

tl::expected<void, Error> Pipelines::State::create_module(std::size_t shader) {
  VkShaderModule& module = shaders[shader].module;
  if (module != VK_NULL_HANDLE) return {};
  const std::span<const std::uint32_t> code = shader_source(static_cast<Shader>(shader)).code;
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = code.size_bytes(),
                                      .pCode = code.data()};
  if (const VkResult result = vk.vkCreateShaderModule(device(), &info, callbacks(), &module);
      result != VK_SUCCESS)
    return creation_error("a shader module", result);
  return {};
}

// Creates the shader's storage buffer with its table, if it has one and the buffer does not exist.
tl::expected<void, Error> Pipelines::State::create_table(std::size_t shader) {
  const std::span<const std::uint32_t> table = shader_source(static_cast<Shader>(shader)).table;
  if (table.empty() || shaders[shader].table) return {};
  auto buffer = HostBuffer::create(vk, handles, "the buffer of a table", table.size_bytes(),
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (!buffer) return tl::unexpected(std::move(buffer.error()));
  std::memcpy((*buffer)->bytes(), table.data(), table.size_bytes());
  shaders[shader].table = std::move(*buffer);
  return {};
}

tl::expected<Pipeline, Error> Pipelines::State::create_pipeline(
    Shader shader, std::span<const AlcoveWorkConstant> constants) {
  const auto index = static_cast<std::size_t>(shader);
  if (auto result = create_module(index).and_then([&] { return create_table(index); }); !result)
    return tl::unexpected(std::move(result.error()));
  std::array<VkSpecializationMapEntry, ALCOVE_MAX_WORK_CONSTANTS> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i) {
    entries.at(i) = {constants[i].id,
                     static_cast<std::uint32_t>(i * sizeof(AlcoveWorkConstant) +
                                                offsetof(AlcoveWorkConstant, value)),
                     sizeof constants[i].value};
  }
  const VkSpecializationInfo specialisation{static_cast<std::uint32_t>(constants.size()),
                                            entries.data(), constants.size_bytes(),
                                            constants.data()};
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = shaders[index].module,
                .pName = "main",
                .pSpecializationInfo = &specialisation},
      .layout = shaders[index].pipeline_layout};
  // The vector grows before the pipeline is created, so that a failed allocation
  // cannot leak the pipeline.
  if (cached.size() == cached.capacity()) cached.reserve(2 * cached.size() + 8);
  CachedPipeline pipeline{shader, {constants.begin(), constants.end()}, VK_NULL_HANDLE};
  if (const VkResult result =
          vk.vkCreateComputePipelines(device(), cache, 1, &info, callbacks(), &pipeline.pipeline);
      result != VK_SUCCESS)
    return creation_error("a compute pipeline", result);
  cached.push_back(std::move(pipeline));
  if (const framegraph::Log& log = handles.host.log; log.write != nullptr)
    log.write(log.user, framegraph::Severity::info, "A compute pipeline has been created.");
  return Pipeline{cached.back().pipeline, shader};
}

Pipelines::Pipelines(std::unique_ptr<State> state) : state_(std::move(state)) {}
Pipelines::Pipelines(Pipelines&&) noexcept = default;
Pipelines& Pipelines::operator=(Pipelines&&) noexcept = default;
Pipelines::~Pipelines() = default;

tl::expected<Pipelines, Error> Pipelines::create(const framegraph::DeviceHandles& device,
                                                 std::uint32_t frames_in_flight,
                                                 VkPipelineCache cache) {
  if (device.instance == VK_NULL_HANDLE || device.physical_device == VK_NULL_HANDLE ||
      device.device == VK_NULL_HANDLE || device.get_instance_proc_addr == nullptr) {
    return tl::unexpected(
        Error{"The occlusion passes need an instance, a physical device, a device and "
              "vkGetInstanceProcAddr; one of them is null."});
  }
  if (frames_in_flight < 1 || frames_in_flight > kMaxFramesInFlight) {
    return tl::unexpected(
        Error{"The occlusion passes were asked for " + std::to_string(frames_in_flight) +
              " frames in flight; there must be 1 to " + std::to_string(kMaxFramesInFlight) + "."});
  }
  auto state = std::make_unique<State>();
  if (const char* missing = framegraph::load(state->vk, device.get_instance_proc_addr,
                                             device.instance, device.device)) {
    return tl::unexpected(
        Error{std::string("The device has no function ") + missing +
                  "; create instance and device for Vulkan 1.3, or for Vulkan 1.2 with "
                  "VK_KHR_synchronization2.",
              ALCOVE_ERROR_UNSUPPORTED});
  }
  state->handles = device;
  state->cache = cache;
  auto done = state->check_limits()
                  .and_then([&] { return state->create_sampler(); })
                  .and_then([&] { return state->create_layouts(); })
                  .and_then([&] { return state->create_sets(frames_in_flight); });
  if (!done) return tl::unexpected(std::move(done.error()));
  return Pipelines(std::move(state));
}

void Pipelines::begin_frame(std::uint32_t slot) { state_->sets->begin_frame(slot); }

tl::expected<Pipeline, Error> Pipelines::State::get(Shader shader,
                                                    std::span<const AlcoveWorkConstant> constants) {
  for (const CachedPipeline& pipeline : cached)
    if (pipeline.shader == shader &&
        std::ranges::equal(pipeline.constants, constants, {}, &AlcoveWorkConstant::value,
                           &AlcoveWorkConstant::value))
      return Pipeline{pipeline.pipeline, shader};
  return create_pipeline(shader, constants);
}

void Pipelines::State::dispatch(framegraph::RecordContext& context, Pipeline pipeline,
                                std::span<const VkImageView> views,
                                std::span<const std::byte> parameters,
                                const std::array<std::uint32_t, 3>& groups) const {
  // A view that could not be created is an error of the frame's record already.
  if (std::ranges::find(views, VkImageView{VK_NULL_HANDLE}) != views.end()) return;
  const ShaderObjects& shader = shaders[static_cast<std::size_t>(pipeline.shader)];
  const VkDescriptorSet set =
      sets->get(context, {.shader = pipeline.shader,
                          .interface = &shader_interface(pipeline.shader),
                          .layout = shader.set_layout,
                          .table = shader.table ? shader.table->buffer() : VkBuffer{VK_NULL_HANDLE},
                          .views = views,
                          .parameters = parameters});
  if (set == VK_NULL_HANDLE) return;
  const VkCommandBuffer commands = context.commands;
  vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
  vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shader.pipeline_layout, 0, 1,
                             &set, 0, nullptr);
  vk.vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
}

std::size_t Pipelines::State::table_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kShaderCount; ++i)
    if (shaders[i].table) bytes += shader_source(static_cast<Shader>(i)).table.size_bytes();
  return bytes;
}

std::size_t Pipelines::pipeline_count() const { return state_->cached.size(); }

VkDeviceSize Pipelines::memory_bytes() const {
  return state_->sets->parameter_bytes() + state_->table_bytes();
}

}  // namespace alcove::passes
