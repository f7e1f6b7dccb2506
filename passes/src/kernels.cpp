#include "alcove/passes/kernels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "host_buffer.h"
#include "shader_table.h"

namespace alcove::passes {
namespace {

constexpr std::size_t kShaderCount = static_cast<std::size_t>(Shader::count);
constexpr std::size_t kMaxBindings = 16;  // the parameters among them
constexpr std::uint32_t kGroupSize = 8;

tl::unexpected<Error> failure(std::string_view what, VkResult result) {
  return tl::unexpected(
      Error{"The occlusion passes could not create " + std::string(what) + ".", result});
}

struct Pipeline {
  Shader shader = Shader::count;
  std::vector<std::uint32_t> constants;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

// A descriptor set, and what was written to it last.
struct Set {
  Shader shader = Shader::count;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::uint64_t resources_id = 0;  // RecordContext::resources_id at that time
  VkDeviceSize parameter_bytes = 0;
  std::size_t view_count = 0;
  std::array<VkImageView, kMaxBindings> views{};
};

// The shader, images and parameters that a dispatch binds.
struct Bound {
  Shader shader = Shader::count;
  std::span<const VkImageView> views;
  VkDeviceSize parameter_bytes = 0;
};

// The sets of one dispatch of a frame slot. There are two, because histories alternate between two
// images: with an odd number of frames in flight a slot meets both of them in turn.
struct DispatchSets {
  std::array<Set, 2> sets;
  std::size_t latest = 0;
};

// Whether the set still holds exactly what the dispatch binds. Equal handles are only the same
// views as long as no image has been replaced, and views that the caller gave may be others at any
// time.
bool holds(const Set& set, const Bound& bound, const framegraph::RecordContext& context) {
  return set.shader == bound.shader && set.resources_id == context.resources_id &&
         !context.gave_imported_view() && set.parameter_bytes == bound.parameter_bytes &&
         std::ranges::equal(std::span(set.views).first(set.view_count), bound.views);
}

VkDescriptorType descriptor_type(char binding) {
  switch (binding) {
    case 's':
      return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case 'g':
      return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case 't':
      return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    default:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  }
}

// Descriptors of a type that a dispatch of any shader binds at most.
std::uint32_t most_bound(VkDescriptorType type) {
  std::ptrdiff_t most = 0;
  for (std::size_t i = 0; i < kShaderCount; ++i) {
    const std::string_view bindings = shader_source(static_cast<Shader>(i)).bindings;
    most = std::max(most, std::ranges::count(bindings, type, descriptor_type));
  }
  return static_cast<std::uint32_t>(most);
}

// A dispatch of a frame, counted from 0, and the set that is its own.
struct Claim {
  std::uint32_t number = 0;
  VkDescriptorSet set = VK_NULL_HANDLE;
  bool is_written = false;  // the set holds what the dispatch binds
};

// Of all that a shader binds only storage images are more than every device can: 4 is Vulkan's
// least.
tl::expected<void, Error> check_limits(const framegraph::VulkanFunctions& vk,
                                       VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties{};
  vk.vkGetPhysicalDeviceProperties(device, &properties);
  const std::uint32_t limit = properties.limits.maxPerStageDescriptorStorageImages;
  const std::uint32_t needed = most_bound(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  if (limit >= needed) {
    return {};
  }
  return tl::unexpected(Error{"The device '" + std::string(properties.deviceName) +
                                  "' binds at most " + std::to_string(limit) +
                                  " storage images to a shader; the occlusion passes need " +
                                  std::to_string(needed) + ".",
                              VK_ERROR_FEATURE_NOT_PRESENT});
}

struct FrameSlot {
  VkDescriptorPool pool = VK_NULL_HANDLE;
  std::array<DispatchSets, Kernels::kMaxDispatches> dispatches;
};

}  // namespace

struct Kernels::State {
  framegraph::VulkanFunctions vk;
  framegraph::DeviceHandles handles;
  VkDevice device = VK_NULL_HANDLE;
  VkPipelineCache cache = VK_NULL_HANDLE;  // the caller's
  VkSampler sampler = VK_NULL_HANDLE;      // nearest, clamps to the edge: for gathers
  std::array<VkShaderModule, kShaderCount> modules{};
  std::array<VkDescriptorSetLayout, kShaderCount> set_layouts{};
  std::array<VkPipelineLayout, kShaderCount> pipeline_layouts{};
  std::vector<Pipeline> pipelines;
  std::vector<FrameSlot> slots;
  std::array<std::unique_ptr<HostBuffer>, kShaderCount> tables;  // null: none, or not yet
  std::unique_ptr<HostBuffer> parameters;
  std::size_t slot = 0;
  // Guards `dispatches` and the slot's sets and pool: several threads record at the same time. What
  // a dispatch has claimed is its own, and needs no lock.
  std::mutex mutex;
  std::uint32_t dispatches = 0;

  const VkAllocationCallbacks* callbacks() const { return handles.host.allocation_callbacks; }

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();

  tl::expected<void, Error> create_sampler();
  tl::expected<void, Error> create_layouts();
  tl::expected<void, Error> create_slots(std::uint32_t count);
  tl::expected<void, Error> create_parameters(std::uint32_t slot_count);
  tl::expected<void, Error> create_buffer(std::unique_ptr<HostBuffer>& made, VkDeviceSize size,
                                          VkBufferUsageFlags usage, std::string_view what);
  tl::expected<void, Error> create_module(std::size_t shader);
  tl::expected<void, Error> create_table(std::size_t shader);
  VkResult allocate_set(Set& set, Shader shader);
  std::optional<Claim> claim(framegraph::RecordContext& context, const Bound& bound);
  VkDeviceSize write_parameters(std::uint32_t dispatch, std::span<const std::byte> bytes);
  void write_set(VkDescriptorSet set, Shader shader, std::span<const VkImageView> views,
                 VkDeviceSize offset, VkDeviceSize size);
};

Kernels::State::~State() {
  if (device == VK_NULL_HANDLE) {
    return;
  }
  for (const Pipeline& pipeline : pipelines) {
    vk.vkDestroyPipeline(device, pipeline.pipeline, callbacks());
  }
  for (std::size_t i = 0; i < kShaderCount; ++i) {
    vk.vkDestroyShaderModule(device, modules[i], callbacks());
    vk.vkDestroyPipelineLayout(device, pipeline_layouts[i], callbacks());
    vk.vkDestroyDescriptorSetLayout(device, set_layouts[i], callbacks());
  }
  for (const FrameSlot& frame : slots) {
    vk.vkDestroyDescriptorPool(device, frame.pool, callbacks());
  }
  vk.vkDestroySampler(device, sampler, callbacks());
}

tl::expected<void, Error> Kernels::State::create_sampler() {
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .magFilter = VK_FILTER_NEAREST,
                                 .minFilter = VK_FILTER_NEAREST,
                                 .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  if (const VkResult result = vk.vkCreateSampler(device, &info, callbacks(), &sampler);
      result != VK_SUCCESS) {
    return failure("a sampler", result);
  }
  return {};
}

tl::expected<void, Error> Kernels::State::create_layouts() {
  for (std::size_t i = 0; i < kShaderCount; ++i) {
    const std::string_view bindings = shader_source(static_cast<Shader>(i)).bindings;
    std::array<VkDescriptorSetLayoutBinding, kMaxBindings> described{};
    assert(bindings.size() < kMaxBindings);
    described[0] = {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    for (std::uint32_t b = 0; b < bindings.size(); ++b) {
      described[b + 1] = {b + 1, descriptor_type(bindings[b]), 1, VK_SHADER_STAGE_COMPUTE_BIT,
                          bindings[b] == 'g' ? &sampler : nullptr};
    }
    const VkDescriptorSetLayoutCreateInfo set_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = static_cast<std::uint32_t>(bindings.size() + 1),
        .pBindings = described.data()};
    VkResult result =
        vk.vkCreateDescriptorSetLayout(device, &set_info, callbacks(), &set_layouts[i]);
    if (result != VK_SUCCESS) {
      return failure("a descriptor set layout", result);
    }
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = 1,
                                          .pSetLayouts = &set_layouts[i]};
    result = vk.vkCreatePipelineLayout(device, &info, callbacks(), &pipeline_layouts[i]);
    if (result != VK_SUCCESS) {
      return failure("a pipeline layout", result);
    }
  }
  return {};
}

tl::expected<void, Error> Kernels::State::create_slots(std::uint32_t count) {
  constexpr auto kSets =
      static_cast<std::uint32_t>(kMaxDispatches * std::tuple_size_v<decltype(DispatchSets::sets)>);
  const auto worst = [](VkDescriptorType type) {
    return VkDescriptorPoolSize{type, kSets * most_bound(type)};
  };
  const std::array<VkDescriptorPoolSize, 5> sizes{{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSets},
                                                   worst(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                                                   worst(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER),
                                                   worst(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE),
                                                   worst(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)}};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                        .maxSets = kSets,
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  slots.resize(count);
  for (FrameSlot& frame : slots) {
    if (const VkResult result = vk.vkCreateDescriptorPool(device, &info, callbacks(), &frame.pool);
        result != VK_SUCCESS) {
      return failure("a descriptor pool", result);
    }
  }
  return {};
}

tl::expected<void, Error> Kernels::State::create_buffer(std::unique_ptr<HostBuffer>& made,
                                                        VkDeviceSize size, VkBufferUsageFlags usage,
                                                        std::string_view what) {
  auto created = HostBuffer::create(vk, handles, size, usage);
  if (!created) {
    return failure("the buffer of " + std::string(what), created.error());
  }
  made = std::move(*created);
  return {};
}

tl::expected<void, Error> Kernels::State::create_parameters(std::uint32_t slot_count) {
  return create_buffer(parameters, VkDeviceSize{slot_count} * kMaxDispatches * kMaxParameterBytes,
                       VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, "parameters");
}

// The table that a shader looks up, where it has one.
tl::expected<void, Error> Kernels::State::create_table(std::size_t shader) {
  const std::span<const std::uint32_t> table = shader_source(static_cast<Shader>(shader)).table;
  std::unique_ptr<HostBuffer>& made = tables[shader];
  if (table.empty() || made) {
    return {};
  }
  return create_buffer(made, table.size_bytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "a table")
      .map([&] { std::memcpy(made->bytes(), table.data(), table.size_bytes()); });
}

tl::expected<void, Error> Kernels::State::create_module(std::size_t shader) {
  if (modules[shader] != VK_NULL_HANDLE) {
    return {};
  }
  const std::span<const std::uint32_t> code = shader_source(static_cast<Shader>(shader)).code;
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = code.size_bytes(),
                                      .pCode = code.data()};
  if (const VkResult result = vk.vkCreateShaderModule(device, &info, callbacks(), &modules[shader]);
      result != VK_SUCCESS) {
    return failure("a shader module", result);
  }
  return {};
}

// Gives `set` a descriptor set for the shader, of unknown contents. The pools are sized for the
// worst frame, so an allocation can fail only for lack of memory.
VkResult Kernels::State::allocate_set(Set& set, Shader shader) {
  if (set.shader == shader) {
    return VK_SUCCESS;
  }
  const VkDescriptorPool pool = slots[slot].pool;
  if (set.set != VK_NULL_HANDLE) {
    vk.vkFreeDescriptorSets(device, pool, 1, &set.set);
  }
  set = {};
  const VkDescriptorSetAllocateInfo info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
      .descriptorPool = pool,
      .descriptorSetCount = 1,
      .pSetLayouts = &set_layouts[static_cast<std::size_t>(shader)]};
  VkDescriptorSet made = VK_NULL_HANDLE;
  const VkResult result = vk.vkAllocateDescriptorSets(device, &info, &made);
  if (result == VK_SUCCESS) {
    set.shader = shader;
    set.set = made;
  }
  return result;
}

// The next dispatch and its set: one that holds what is bound, or else the one of its two that has
// not been used for longer. None, and an error of the frame's, where there is no room for another
// dispatch.
std::optional<Claim> Kernels::State::claim(framegraph::RecordContext& context, const Bound& bound) {
  const std::lock_guard lock(mutex);
  if (dispatches == kMaxDispatches) {
    context.fail("dispatch after Kernels::kMaxDispatches of them since Kernels::begin_frame",
                 VK_ERROR_OUT_OF_POOL_MEMORY);
    return std::nullopt;
  }
  DispatchSets& own = slots[slot].dispatches[dispatches];
  for (Set& set : own.sets) {
    if (holds(set, bound, context)) {
      own.latest = static_cast<std::size_t>(&set - own.sets.data());
      return Claim{dispatches++, set.set, true};
    }
  }
  own.latest = 1 - own.latest;
  Set& replaced = own.sets.at(own.latest);
  if (const VkResult result = allocate_set(replaced, bound.shader); result != VK_SUCCESS) {
    context.fail("descriptor set", result);
    return std::nullopt;
  }
  replaced.resources_id = context.resources_id;
  replaced.parameter_bytes = bound.parameter_bytes;
  replaced.view_count = bound.views.size();
  std::ranges::copy(bound.views, replaced.views.begin());
  return Claim{dispatches++, replaced.set, false};
}

VkDeviceSize Kernels::State::write_parameters(std::uint32_t dispatch,
                                              std::span<const std::byte> bytes) {
  assert(bytes.size() <= kMaxParameterBytes);
  const VkDeviceSize offset = (slot * kMaxDispatches + dispatch) * kMaxParameterBytes;
  std::memcpy(parameters->bytes() + offset, bytes.data(), bytes.size());
  return offset;
}

void Kernels::State::write_set(VkDescriptorSet set, Shader shader,
                               std::span<const VkImageView> views, VkDeviceSize offset,
                               VkDeviceSize size) {
  const std::string_view bindings = shader_source(shader).bindings;
  const HostBuffer* const table = tables[static_cast<std::size_t>(shader)].get();
  assert(views.size() + (table ? 1 : 0) == bindings.size());
  const VkDescriptorBufferInfo buffer{parameters->buffer(), offset, size};
  const VkDescriptorBufferInfo table_buffer{table ? table->buffer() : VK_NULL_HANDLE, 0,
                                            VK_WHOLE_SIZE};
  std::array<VkDescriptorImageInfo, kMaxBindings> images;
  std::array<VkWriteDescriptorSet, kMaxBindings> writes;
  for (std::uint32_t i = 0; i <= bindings.size(); ++i) {
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = set,
                 .dstBinding = i,
                 .descriptorCount = 1,
                 .descriptorType =
                     i == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : descriptor_type(bindings[i - 1]),
                 .pImageInfo = &images[i],
                 .pBufferInfo = i == 0 ? &buffer : &table_buffer};
  }
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    images[i + 1] = {
        VK_NULL_HANDLE, views[i],
        bindings[i] == 't' ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  }
  vk.vkUpdateDescriptorSets(device, static_cast<std::uint32_t>(bindings.size() + 1), writes.data(),
                            0, nullptr);
}

Kernels::Kernels(std::unique_ptr<State> state) : state_(std::move(state)) {}
Kernels::Kernels(Kernels&&) noexcept = default;
Kernels& Kernels::operator=(Kernels&&) noexcept = default;
Kernels::~Kernels() = default;

tl::expected<Kernels, Error> Kernels::create(const framegraph::DeviceHandles& device,
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
              VK_ERROR_FEATURE_NOT_PRESENT});
  }
  state->handles = device;
  state->device = device.device;
  state->cache = cache;
  auto done = check_limits(state->vk, device.physical_device)
                  .and_then([&] { return state->create_sampler(); })
                  .and_then([&] { return state->create_layouts(); })
                  .and_then([&] { return state->create_slots(frames_in_flight); })
                  .and_then([&] { return state->create_parameters(frames_in_flight); });
  if (!done) {
    return tl::unexpected(std::move(done.error()));
  }
  return Kernels(std::move(state));
}

void Kernels::begin_frame(std::uint32_t slot) {
  state_->slot = slot;
  state_->dispatches = 0;
}

tl::expected<Kernel, Error> Kernels::get_pipeline(Shader shader,
                                                  std::span<const std::uint32_t> constants) {
  State& s = *state_;
  for (const Pipeline& made : s.pipelines) {
    if (made.shader == shader && std::ranges::equal(made.constants, constants)) {
      return Kernel{made.pipeline, shader};
    }
  }
  const auto index = static_cast<std::size_t>(shader);
  if (auto made = s.create_module(index).and_then([&] { return s.create_table(index); }); !made) {
    return tl::unexpected(std::move(made.error()));
  }
  assert(constants.size() <= kMaxConstants);
  std::array<VkSpecializationMapEntry, kMaxConstants> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i) {
    entries[i] = {i, i * 4, 4};
  }
  const VkSpecializationInfo specialisation{static_cast<std::uint32_t>(constants.size()),
                                            entries.data(), constants.size_bytes(),
                                            constants.data()};
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = s.modules[index],
                .pName = "main",
                .pSpecializationInfo = &specialisation},
      .layout = s.pipeline_layouts[index]};
  // Room first: where memory gives out no pipeline is lost.
  if (s.pipelines.size() == s.pipelines.capacity()) {
    s.pipelines.reserve(2 * s.pipelines.size() + 8);
  }
  Pipeline made{shader, {constants.begin(), constants.end()}, VK_NULL_HANDLE};
  if (const VkResult result =
          s.vk.vkCreateComputePipelines(s.device, s.cache, 1, &info, s.callbacks(), &made.pipeline);
      result != VK_SUCCESS) {
    return failure("a compute pipeline", result);
  }
  s.pipelines.push_back(std::move(made));
  if (const framegraph::Log& log = s.handles.host.log; log.write != nullptr) {
    log.write(log.user, framegraph::Severity::info, "A compute pipeline has been created.");
  }
  return Kernel{s.pipelines.back().pipeline, shader};
}

void Kernels::dispatch(framegraph::RecordContext& context, Kernel kernel,
                       std::span<const VkImageView> views, std::span<const std::byte> parameters,
                       VkExtent3D size) {
  State& s = *state_;
  if (s.slot >= s.slots.size()) {
    context.fail("dispatch of a slot that is not below the frames in flight of Kernels::create",
                 VK_ERROR_OUT_OF_POOL_MEMORY);
    return;
  }
  // A view that could not be made is an error that the frame's record returns.
  if (std::ranges::find(views, VkImageView{VK_NULL_HANDLE}) != views.end()) {
    return;
  }
  const std::optional<Claim> own = s.claim(context, {kernel.shader, views, parameters.size()});
  if (!own) {
    return;
  }
  const VkDeviceSize offset = s.write_parameters(own->number, parameters);
  if (!own->is_written) {
    s.write_set(own->set, kernel.shader, views, offset, parameters.size());
  }
  const VkCommandBuffer commands = context.commands;
  const VkPipelineLayout layout = s.pipeline_layouts[static_cast<std::size_t>(kernel.shader)];
  s.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline);
  s.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &own->set, 0,
                               nullptr);
  s.vk.vkCmdDispatch(commands, (size.width + kGroupSize - 1) / kGroupSize,
                     (size.height + kGroupSize - 1) / kGroupSize, size.depth);
}

std::size_t Kernels::pipeline_count() const { return state_->pipelines.size(); }

VkDeviceSize Kernels::memory_bytes() const {
  return VkDeviceSize{state_->slots.size()} * kMaxDispatches * kMaxParameterBytes + table_bytes();
}

std::size_t Kernels::table_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kShaderCount; ++i) {
    if (state_->tables[i]) {
      bytes += shader_source(static_cast<Shader>(i)).table.size_bytes();
    }
  }
  return bytes;
}

}  // namespace alcove::passes
