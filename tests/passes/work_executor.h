// Executes lists of work with plain Vulkan: an example of a backend that has nothing in common with
// the library but alcove_work.h. It allocates its own memory from the engine, in which transients
// share bytes by their lifetimes, records its own barriers, and keeps its own histories.
#pragma once

#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "alcove/alcove_work.h"
#include "engine.h"

namespace alcove::passes {

class WorkExecutor {
 public:
  // With `own_shader`, every dispatch runs it instead of the library's shader.
  explicit WorkExecutor(const TestEngine& engine, AlcoveShader own_shader = {})
      : engine_(engine), device_(engine.device().device()), own_shader_(own_shader) {
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    check(vkCreateSampler(device_, &info, nullptr, &sampler_));
    std::array<VkDescriptorPoolSize, 5> sizes;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      sizes[i] = {descriptor_type(i), ALCOVE_MAX_WORK_DISPATCHES * ALCOVE_MAX_WORK_BINDINGS};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = ALCOVE_MAX_WORK_DISPATCHES,
                                          .poolSizeCount = sizes.size(),
                                          .pPoolSizes = sizes.data()};
    check(vkCreateDescriptorPool(device_, &pool, nullptr, &pool_));
  }
  ~WorkExecutor() {
    destroy_frame();
    destroy_histories();
    for (const auto& [name, pipeline] : pipelines_) {
      vkDestroyPipeline(device_, pipeline.pipeline, nullptr);
      vkDestroyPipelineLayout(device_, pipeline.layout, nullptr);
      vkDestroyDescriptorSetLayout(device_, pipeline.set_layout, nullptr);
    }
    vkDestroyDescriptorPool(device_, pool_, nullptr);
    vkDestroySampler(device_, sampler_, nullptr);
  }

  // Records a list. `host` has a colour image for each input and output, in the order of the
  // resources and in the layout kRead, in which the executor leaves it. The device must have
  // finished the last frame.
  void record(VkCommandBuffer commands, const AlcoveWork& work, std::span<const VkImage> host) {
    destroy_frame();
    create_images(work, host);
    for (std::uint32_t i = 0; i < work.dispatch_count; ++i) {
      const AlcoveWorkDispatch& dispatch = work.dispatches[i];
      record_barriers(commands, dispatch);
      const Pipeline& pipeline = get_pipeline(dispatch);
      const VkDescriptorSet set = create_set(work, dispatch, pipeline);
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set,
                              0, nullptr);
      vkCmdDispatch(commands, dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
    }
    std::vector<VkImageMemoryBarrier2> barriers;
    for (std::size_t i = 0; i < host.size(); ++i)  // the engine's images come first
      barriers.push_back(barrier(i, kRead));
    record(commands, barriers);
    destroy_histories();  // those that were not continued
    for (std::uint32_t i = 0; i < work.history_count; ++i) {
      Image& written = images_[work.histories[i].current];
      histories_[work.resources[work.histories[i].current].name] = written;
      written = {};
    }
  }

 private:
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;  // of a history
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool owned = false;
  };
  struct Pipeline {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
  };

  static constexpr auto kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

  static void check(VkResult result) { ASSERT_EQ(result, VK_SUCCESS); }

  static VkDescriptorType descriptor_type(std::size_t binding_type) {
    constexpr std::array kTypes{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_SAMPLER,
                                VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    return kTypes.at(binding_type);
  }

  Image create_image(const AlcoveWorkResource& resource) const {
    // A history is stored to in one frame and sampled in the next.
    const bool history = resource.kind != ALCOVE_RESOURCE_KIND_TRANSIENT;
    constexpr VkImageUsageFlags kSampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    constexpr VkImageUsageFlags kStored = VK_IMAGE_USAGE_STORAGE_BIT;
    constexpr std::array kUsages{0u, kSampled, kStored, kSampled | kStored};
    const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                 .imageType = VK_IMAGE_TYPE_2D,
                                 .format = static_cast<VkFormat>(resource.format),
                                 .extent = {resource.width, resource.height, 1},
                                 .mipLevels = 1,
                                 .arrayLayers = 1,
                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                 .usage = kUsages.at(history ? 3u : resource.usage)};
    Image image{.owned = true};
    check(vkCreateImage(device_, &info, nullptr, &image.image));
    if (history) {
      VkMemoryRequirements needs{};
      vkGetImageMemoryRequirements(device_, image.image, &needs);
      check(engine_.device().allocate(needs, 0, image.memory));
      check(vkBindImageMemory(device_, image.image, image.memory, 0));
    }
    return image;
  }

  void create_images(const AlcoveWork& work, std::span<const VkImage> host) {
    for (std::size_t i = 0; i < work.resource_count; ++i) {
      const AlcoveWorkResource& resource = work.resources[i];
      Image image;
      if (i < host.size())
        image = {.image = host[i], .layout = kRead};
      else if (resource.kind == ALCOVE_RESOURCE_KIND_HISTORY_PREVIOUS && work.history_valid)
        image = histories_.extract(resource.name).mapped();
      else if (resource.kind != ALCOVE_RESOURCE_KIND_TABLE)
        image = create_image(resource);
      images_.push_back(image);
    }
    place_transients(work);
    for (std::size_t i = 0; i < images_.size(); ++i) {
      const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                       .image = images_[i].image,
                                       .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                       .format = static_cast<VkFormat>(work.resources[i].format),
                                       .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
      if (images_[i].image != VK_NULL_HANDLE && images_[i].view == VK_NULL_HANDLE)
        check(vkCreateImageView(device_, &info, nullptr, &images_[i].view));
    }
  }

  // Places each transient at the lowest offset at which no other transient lies whose lifetime
  // overlaps with its own.
  void place_transients(const AlcoveWork& work) {
    struct Place {
      VkDeviceSize begin, end;
      std::uint32_t first, last;
      VkImage image;
    };
    std::vector<Place> places;
    VkMemoryRequirements all{.size = 0, .alignment = 1, .memoryTypeBits = ~0u};
    for (std::size_t i = 0; i < images_.size(); ++i) {
      const AlcoveWorkResource& resource = work.resources[i];
      if (resource.kind != ALCOVE_RESOURCE_KIND_TRANSIENT) continue;
      VkMemoryRequirements needs{};
      vkGetImageMemoryRequirements(device_, images_[i].image, &needs);
      Place place{0, needs.size, resource.first_dispatch, resource.last_dispatch, images_[i].image};
      const auto collides = [&](const Place& other) {
        return place.begin < other.end && other.begin < place.end && place.first <= other.last &&
               other.first <= place.last;
      };
      for (auto hit = places.begin();
           (hit = std::ranges::find_if(places, collides)) != places.end();) {
        place.begin = (hit->end + needs.alignment - 1) / needs.alignment * needs.alignment;
        place.end = place.begin + needs.size;
      }
      all.size = std::max(all.size, place.end);
      all.memoryTypeBits &= needs.memoryTypeBits;
      places.push_back(place);
    }
    if (!places.empty()) check(engine_.device().allocate(all, 0, transients_));
    for (const Place& place : places)
      check(vkBindImageMemory(device_, place.image, transients_, place.begin));
  }

  const Pipeline& get_pipeline(const AlcoveWorkDispatch& dispatch) {
    const std::size_t constant_bytes = dispatch.constant_count * sizeof dispatch.constants[0];
    std::string key(dispatch.shader);
    key.append(reinterpret_cast<const char*>(dispatch.constants), constant_bytes);
    const auto [entry, is_new] = pipelines_.try_emplace(key);
    Pipeline& pipeline = entry->second;
    if (!is_new) return pipeline;
    std::array<VkDescriptorSetLayoutBinding, ALCOVE_MAX_WORK_BINDINGS> bindings;
    for (std::uint32_t i = 0; i < dispatch.binding_count; ++i) {
      const AlcoveWorkBinding& of = dispatch.bindings[i];
      bindings[i] = {of.number, descriptor_type(of.type), 1, VK_SHADER_STAGE_COMPUTE_BIT,
                     of.type == ALCOVE_BINDING_TYPE_SAMPLER ? &sampler_ : nullptr};
    }
    const VkDescriptorSetLayoutCreateInfo set{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = dispatch.binding_count,
        .pBindings = bindings.data()};
    check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &pipeline.set_layout));
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &pipeline.set_layout};
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &pipeline.layout));
    AlcoveShader shader = own_shader_;
    if (shader.code == nullptr) {
      EXPECT_EQ(alcoveGetShader(dispatch.shader, &shader), ALCOVE_SUCCESS);
    }
    const VkShaderModuleCreateInfo code{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = shader.code_size,
                                        .pCode = shader.code};
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device_, &code, nullptr, &module));
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < dispatch.constant_count; ++i) {
      const std::size_t offset =
          i * sizeof(AlcoveWorkConstant) + offsetof(AlcoveWorkConstant, value);
      entries.push_back(
          {dispatch.constants[i].id, static_cast<uint32_t>(offset), sizeof(uint32_t)});
    }
    const VkSpecializationInfo constants{dispatch.constant_count, entries.data(), constant_bytes,
                                         dispatch.constants};
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &constants},
        .layout = pipeline.layout};
    check(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.pipeline));
    vkDestroyShaderModule(device_, module, nullptr);
    return pipeline;
  }

  // Changes the layout of an image. Other commands than those of the executor use the engine's
  // images, and an image without contents may share the memory of one that a dispatch has used.
  VkImageMemoryBarrier2 barrier(std::size_t resource, VkImageLayout layout) {
    const VkPipelineStageFlags2 stages = images_[resource].owned
                                             ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
                                             : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = stages,
            .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
            .dstStageMask = stages,
            .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
            .oldLayout = std::exchange(images_[resource].layout, layout),
            .newLayout = layout,
            .image = images_[resource].image,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  }

  // Records these barriers, and makes what earlier dispatches wrote visible to the next one.
  static void record(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> barriers) {
    const VkMemoryBarrier2 written{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .dstAccessMask = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &written,
                                .imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size()),
                                .pImageMemoryBarriers = barriers.data()};
    vkCmdPipelineBarrier2(commands, &info);
  }

  // An image that is stored to needs the layout GENERAL, and others SHADER_READ_ONLY_OPTIMAL.
  void record_barriers(VkCommandBuffer commands, const AlcoveWorkDispatch& dispatch) {
    std::map<std::uint32_t, VkImageLayout> layouts;
    for (std::uint32_t i = 0; i < dispatch.binding_count; ++i) {
      const AlcoveWorkBinding& of = dispatch.bindings[i];
      if (of.type >= ALCOVE_BINDING_TYPE_FETCHED_IMAGE) {
        layouts[of.resource] =
            of.type == ALCOVE_BINDING_TYPE_STORAGE_IMAGE ? VK_IMAGE_LAYOUT_GENERAL : kRead;
      }
    }
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const auto& [resource, layout] : layouts)
      if (images_[resource].layout != layout) barriers.push_back(barrier(resource, layout));
    record(commands, barriers);
  }

  VkBuffer create_buffer(VkBufferUsageFlags usage, const void* bytes, VkDeviceSize size) {
    buffers_.push_back(engine_.create_buffer(usage, size));
    std::memcpy(buffers_.back()->bytes().data(), bytes, size);
    return buffers_.back()->buffer();
  }

  VkDescriptorSet create_set(const AlcoveWork& work, const AlcoveWorkDispatch& dispatch,
                             const Pipeline& pipeline) {
    const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = pool_,
                                           .descriptorSetCount = 1,
                                           .pSetLayouts = &pipeline.set_layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(device_, &info, &set));
    for (std::uint32_t i = 0; i < dispatch.binding_count; ++i) {
      const AlcoveWorkBinding& of = dispatch.bindings[i];
      if (of.type == ALCOVE_BINDING_TYPE_SAMPLER) continue;  // the layout has it
      VkDescriptorBufferInfo buffer{VK_NULL_HANDLE, 0, VK_WHOLE_SIZE};
      VkDescriptorImageInfo image{};
      if (of.type == ALCOVE_BINDING_TYPE_PARAMETERS) {
        buffer.buffer = create_buffer(VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, dispatch.parameters,
                                      dispatch.parameter_bytes);
      } else if (of.type == ALCOVE_BINDING_TYPE_TABLE) {
        buffer.buffer =
            create_buffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, work.resources[of.resource].data,
                          work.resources[of.resource].size);
      } else {
        image = {VK_NULL_HANDLE, images_[of.resource].view, images_[of.resource].layout};
      }
      const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = set,
                                       .dstBinding = of.number,
                                       .descriptorCount = 1,
                                       .descriptorType = descriptor_type(of.type),
                                       .pImageInfo = &image,
                                       .pBufferInfo = &buffer};
      vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }
    return set;
  }

  void destroy(const Image& image) const {
    vkDestroyImageView(device_, image.view, nullptr);
    if (image.owned) {
      vkDestroyImage(device_, image.image, nullptr);
      vkFreeMemory(device_, image.memory, nullptr);
    }
  }
  void destroy_histories() {
    std::ranges::for_each(histories_, [&](const auto& named) { destroy(named.second); });
    histories_.clear();
  }
  void destroy_frame() {
    std::ranges::for_each(images_, [&](const Image& image) { destroy(image); });
    vkFreeMemory(device_, std::exchange(transients_, VK_NULL_HANDLE), nullptr);
    check(vkResetDescriptorPool(device_, pool_, 0));
    images_.clear();
    buffers_.clear();
  }

  const TestEngine& engine_;
  VkDevice device_;
  AlcoveShader own_shader_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::map<std::string, Pipeline> pipelines_;  // by shader and constants
  std::map<std::string, Image> histories_;     // written in the last frame, by name
  // State of the current frame.
  std::vector<Image> images_;  // parallel to the resources
  std::vector<std::unique_ptr<sample::HostBuffer>> buffers_;
  VkDeviceMemory transients_ = VK_NULL_HANDLE;
};

}  // namespace alcove::passes
