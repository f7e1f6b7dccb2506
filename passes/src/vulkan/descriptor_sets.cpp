#include "vulkan/descriptor_sets.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <tuple>

#include "vulkan/vulkan_error.h"
#include "work/shader_table.h"

namespace alcove::passes {
namespace {

// The most descriptors of a type that one of the shaders binds.
std::uint32_t most_bound(VkDescriptorType type) {
  std::ptrdiff_t most = 0;
  for (std::size_t shader = 0; shader < static_cast<std::size_t>(Shader::count); ++shader) {
    most = std::max(most, std::ranges::count(shader_interface(static_cast<Shader>(shader)).bindings,
                                             type, &ShaderBinding::type));
  }
  return static_cast<std::uint32_t>(most);
}

}  // namespace

tl::expected<std::unique_ptr<DescriptorSets>, Error> DescriptorSets::create(
    const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device,
    std::uint32_t slot_count) {
  std::unique_ptr<DescriptorSets> sets(new DescriptorSets(vk, device));
  if (const VkResult result = sets->create_pools(slot_count); result != VK_SUCCESS)
    return creation_error("a descriptor pool", result);
  auto parameters = HostBuffer::create(vk, device, "the buffer of parameters",
                                       sets->parameter_bytes(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  if (!parameters) return tl::unexpected(std::move(parameters.error()));
  sets->parameters_ = std::move(*parameters);
  return sets;
}

DescriptorSets::~DescriptorSets() {
  for (const FrameSlot& frame : slots_)
    vk_.vkDestroyDescriptorPool(device_.device, frame.pool, device_.host.allocation_callbacks);
}

VkResult DescriptorSets::create_pools(std::uint32_t slot_count) {
  constexpr auto kSets = static_cast<std::uint32_t>(
      Pipelines::kMaxDispatches * std::tuple_size_v<decltype(DispatchSets::sets)>);
  std::array<VkDescriptorPoolSize, 5> sizes{{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                             {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                             {VK_DESCRIPTOR_TYPE_SAMPLER},
                                             {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                             {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}};
  for (VkDescriptorPoolSize& size : sizes) size.descriptorCount = kSets * most_bound(size.type);
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                        .maxSets = kSets,
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  slots_.resize(slot_count);
  for (FrameSlot& frame : slots_)
    if (const VkResult result = vk_.vkCreateDescriptorPool(
            device_.device, &info, device_.host.allocation_callbacks, &frame.pool);
        result != VK_SUCCESS)
      return result;
  return VK_SUCCESS;
}

void DescriptorSets::begin_frame(std::uint32_t slot) {
  slot_ = slot;
  dispatches_ = 0;
}

VkDescriptorSet DescriptorSets::get(framegraph::RecordContext& context,
                                    const DispatchBindings& bound) {
  if (slot_ >= slots_.size()) {
    context.fail("dispatch of a slot that is not below the frames in flight of Pipelines::create",
                 VK_ERROR_OUT_OF_POOL_MEMORY);
    return VK_NULL_HANDLE;
  }
  const Claim own = claim(context, bound);
  if (own.set == VK_NULL_HANDLE) return VK_NULL_HANDLE;
  assert(bound.parameters.size() <= ALCOVE_MAX_WORK_PARAMETER_BYTES);
  const VkDeviceSize offset =
      (slot_ * Pipelines::kMaxDispatches + own.number) * ALCOVE_MAX_WORK_PARAMETER_BYTES;
  std::memcpy(parameters_->bytes() + offset, bound.parameters.data(), bound.parameters.size());
  if (!own.is_written) write(own.set, bound, offset);
  return own.set;
}

VkDeviceSize DescriptorSets::parameter_bytes() const {
  return VkDeviceSize{slots_.size()} * Pipelines::kMaxDispatches * ALCOVE_MAX_WORK_PARAMETER_BYTES;
}

// Returns whether the set still holds the resources that the dispatch binds. Equal handles mean
// equal views only if no image was replaced since (RecordContext::handle_epoch). A view that the
// caller imported may have been replaced at any time.
bool DescriptorSets::holds(const Set& set, const DispatchBindings& bound,
                           const framegraph::RecordContext& context) {
  return set.shader == bound.shader && set.handle_epoch == context.handle_epoch &&
         !context.gave_imported_view() && set.parameter_bytes == bound.parameters.size() &&
         std::ranges::equal(std::span(set.views).first(set.view_count), bound.views);
}

// Gives `set` a descriptor set with the shader's layout and undefined contents. The pools are sized
// for the largest possible frame, so an allocation fails only if memory runs out.
VkResult DescriptorSets::allocate(Set& set, const DispatchBindings& bound) {
  if (set.shader == bound.shader) return VK_SUCCESS;
  const VkDescriptorPool pool = slots_[slot_].pool;
  if (set.set != VK_NULL_HANDLE) vk_.vkFreeDescriptorSets(device_.device, pool, 1, &set.set);
  set = {};
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &bound.layout};
  VkDescriptorSet handle = VK_NULL_HANDLE;
  const VkResult result = vk_.vkAllocateDescriptorSets(device_.device, &info, &handle);
  if (result == VK_SUCCESS) {
    set.shader = bound.shader;
    set.set = handle;
  }
  return result;
}

// Assigns the frame's next dispatch. Of its two descriptor sets, chooses the one that already holds
// the bound resources. If neither does, chooses the one that was used less recently, to be
// rewritten.
DescriptorSets::Claim DescriptorSets::claim(framegraph::RecordContext& context,
                                            const DispatchBindings& bound) {
  if (dispatches_ == Pipelines::kMaxDispatches) {
    context.fail("dispatch after Pipelines::kMaxDispatches of them since Pipelines::begin_frame",
                 VK_ERROR_OUT_OF_POOL_MEMORY);
    return {};
  }
  DispatchSets& own = slots_[slot_].dispatches[dispatches_];
  for (std::size_t i = 0; i < own.sets.size(); ++i) {
    if (const Set& set = own.sets.at(i); holds(set, bound, context)) {
      own.latest = i;
      return {dispatches_++, set.set, true};
    }
  }
  own.latest = 1 - own.latest;
  Set& replaced = own.sets.at(own.latest);
  if (const VkResult result = allocate(replaced, bound); result != VK_SUCCESS) {
    context.fail("descriptor set", result);
    return {};
  }
  replaced.handle_epoch = context.handle_epoch;
  replaced.parameter_bytes = bound.parameters.size();
  replaced.view_count = bound.views.size();
  std::ranges::copy(bound.views, replaced.views.begin());
  return {dispatches_++, replaced.set, false};
}

void DescriptorSets::write(VkDescriptorSet set, const DispatchBindings& bound,
                           VkDeviceSize offset) {
  const VkDescriptorBufferInfo parameters{parameters_->buffer(), offset, bound.parameters.size()};
  const VkDescriptorBufferInfo table{bound.table, 0, VK_WHOLE_SIZE};
  std::array<VkDescriptorImageInfo, kMaxBindings> images;
  std::array<VkWriteDescriptorSet, kMaxBindings> writes;
  std::size_t image_count = 0;
  std::uint32_t write_count = 0;
  for (const ShaderBinding& binding : bound.interface->bindings) {
    if (binding.type == VK_DESCRIPTOR_TYPE_SAMPLER) continue;  // the layout has it
    VkWriteDescriptorSet& write = writes.at(write_count++);
    write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
             .dstSet = set,
             .dstBinding = binding.number,
             .descriptorCount = 1,
             .descriptorType = binding.type};
    if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) {
      write.pBufferInfo = &parameters;
    } else if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) {
      write.pBufferInfo = &table;
    } else {
      const VkImageView view = bound.views[image_count];
      images.at(image_count) = {VK_NULL_HANDLE, view,
                                binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                    ? VK_IMAGE_LAYOUT_GENERAL
                                    : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      write.pImageInfo = &images.at(image_count++);
    }
  }
  assert(image_count == bound.views.size());
  vk_.vkUpdateDescriptorSets(device_.device, write_count, writes.data(), 0, nullptr);
}

}  // namespace alcove::passes
