#include "gpu_cost/recording_device.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "gpu_cost/silent_standard_error.h"

namespace alcove::sample {

// The Vulkan functions that the RecordingDevice implements. The handles VkDevice and
// VkCommandBuffer that they receive are pointers to the RecordingDevice.
struct RecordingFunctions {
  template <typename Handle>
  static RecordingDevice& self(Handle handle) {
    return *reinterpret_cast<RecordingDevice*>(handle);
  }

  template <typename Handle>
  static Handle new_handle(RecordingDevice& device) {
    return (Handle)(device.next_handle());  // handles are pointers or integers by platform
  }

  // Nothing<Function>::call is a Vulkan function of the type `Function` that does nothing and
  // succeeds. If it creates an object, it returns a new handle.
  template <typename Function>
  struct Nothing;

  template <typename Result, typename... Arguments>
  struct Nothing<Result(VKAPI_PTR*)(Arguments...)> {
    static VKAPI_ATTR Result VKAPI_CALL call(Arguments... /*arguments*/) {
      if constexpr (!std::is_void_v<Result>) {
        return {};
      }
    }
  };

  template <typename Info, typename Handle>
  requires(!std::is_const_v<Handle>) struct Nothing<
      VkResult(VKAPI_PTR*)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*)> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, const Info* /*info*/,
                                               const VkAllocationCallbacks* /*callbacks*/,
                                               Handle* handle) {
      *handle = new_handle<Handle>(self(device));
      return VK_SUCCESS;
    }
  };

  // Invocations in a workgroup of a SPIR-V module: the product of its execution mode LocalSize.
  static std::uint32_t group_size(const VkShaderModuleCreateInfo& info) {
    constexpr std::uint32_t kExecutionMode = 16;
    constexpr std::uint32_t kLocalSize = 17;
    constexpr std::size_t kHeaderWords = 5;
    const std::size_t count = info.codeSize / sizeof(std::uint32_t);
    for (std::size_t i = kHeaderWords; i + 5 < count;) {
      const std::uint32_t* word = info.pCode + i;
      if ((word[0] & 0xffffu) == kExecutionMode && word[2] == kLocalSize) {
        return word[3] * word[4] * word[5];
      }
      i += std::max(word[0] >> 16u, 1u);
    }
    return 1;
  }

  // Functions that forward to the driver.
  static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device,
                                                      const VkShaderModuleCreateInfo* info,
                                                      const VkAllocationCallbacks* callbacks,
                                                      VkShaderModule* module) {
    const VkResult result =
        vkCreateShaderModule(self(device).device_.device, info, callbacks, module);
    if (result == VK_SUCCESS) {
      self(device).group_sizes_[*module] = group_size(*info);
      self(device).codes_[*module].assign(reinterpret_cast<const char*>(info->pCode),
                                          info->codeSize);
    }
    return result;
  }

  static VKAPI_ATTR VkResult VKAPI_CALL create_sampler(VkDevice device,
                                                       const VkSamplerCreateInfo* info,
                                                       const VkAllocationCallbacks* callbacks,
                                                       VkSampler* sampler) {
    return vkCreateSampler(self(device).device_.device, info, callbacks, sampler);
  }

  static VKAPI_ATTR VkResult VKAPI_CALL
  create_set_layout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* info,
                    const VkAllocationCallbacks* callbacks, VkDescriptorSetLayout* layout) {
    return vkCreateDescriptorSetLayout(self(device).device_.device, info, callbacks, layout);
  }

  static VKAPI_ATTR VkResult VKAPI_CALL
  create_pipeline_layout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                         const VkAllocationCallbacks* callbacks, VkPipelineLayout* layout) {
    return vkCreatePipelineLayout(self(device).device_.device, info, callbacks, layout);
  }

  // Returns the shader as this process compiled it before for this driver's device, or an empty one
  // to fill. Settings that differ in few constants share most of their shaders.
  static CompiledShader& known_shader(RecordingDevice& recording,
                                      const VkPipelineShaderStageCreateInfo& stage) {
    static std::map<std::string, CompiledShader> known;
    std::string key = recording.device_.name + '\n' + recording.codes_[stage.module];
    if (const VkSpecializationInfo* constants = stage.pSpecializationInfo) {
      key.append(reinterpret_cast<const char*>(constants->pMapEntries),
                 constants->mapEntryCount * sizeof(VkSpecializationMapEntry));
      key.append(static_cast<const char*>(constants->pData), constants->dataSize);
    }
    return known[key];
  }

  static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache /*cache*/,
                                                         std::uint32_t count,
                                                         const VkComputePipelineCreateInfo* infos,
                                                         const VkAllocationCallbacks* callbacks,
                                                         VkPipeline* pipelines) {
    RecordingDevice& recording = self(device);
    const SilentStandardError
        silent;  // ACO prints a warning if it finds no disassembler for old GPUs
    for (std::uint32_t i = 0; i < count; ++i) {
      VkComputePipelineCreateInfo info = infos[i];
      CompiledShader& known = known_shader(recording, info.stage);
      if (!known.statistics.empty()) {
        pipelines[i] = new_handle<VkPipeline>(recording);
        recording.compiled_[pipelines[i]] = known;
        continue;
      }
      info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
                    VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
      const VkResult result = vkCreateComputePipelines(recording.device_.device, VK_NULL_HANDLE, 1,
                                                       &info, callbacks, &pipelines[i]);
      if (result != VK_SUCCESS) {
        return result;
      }
      auto compiled = read_compiled_shader(recording.device_.device, pipelines[i]);
      if (!compiled) {
        recording.error_ = compiled.error();
        return VK_ERROR_FEATURE_NOT_PRESENT;
      }
      compiled->group = recording.group_sizes_[info.stage.module];
      known = *compiled;
      recording.compiled_[pipelines[i]] = std::move(*compiled);
    }
    return VK_SUCCESS;
  }

  // Device memory is allocated from the host's heap.
  static VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device,
                                                        const VkMemoryAllocateInfo* info,
                                                        const VkAllocationCallbacks* /*callbacks*/,
                                                        VkDeviceMemory* memory) {
    *memory = new_handle<VkDeviceMemory>(self(device));
    self(device).memory_[(std::uint64_t)(*memory)] =
        std::make_unique<std::byte[]>(info->allocationSize);
    return VK_SUCCESS;
  }

  static VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice device, VkDeviceMemory memory,
                                                   VkDeviceSize offset, VkDeviceSize /*size*/,
                                                   VkMemoryMapFlags /*flags*/, void** mapped) {
    *mapped = self(device).memory_.at((std::uint64_t)(memory)).get() + offset;
    return VK_SUCCESS;
  }

  // The null device has no memory of its own.
  static VKAPI_ATTR void VKAPI_CALL
  memory_properties(VkPhysicalDevice /*device*/, VkPhysicalDeviceMemoryProperties* properties) {
    *properties = {};
    properties->memoryTypeCount = properties->memoryHeapCount = 1;
    properties->memoryTypes[0].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
                                               VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                               VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    properties->memoryHeaps[0] = {VkDeviceSize{1} << 32u, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
  }
  static constexpr VkMemoryRequirements kRequirements{VkDeviceSize{1} << 20u, 4096, 1u};
  static VKAPI_ATTR void VKAPI_CALL buffer_requirements(VkDevice /*device*/, VkBuffer /*buffer*/,
                                                        VkMemoryRequirements* requirements) {
    *requirements = kRequirements;
  }
  static VKAPI_ATTR void VKAPI_CALL image_requirements(VkDevice /*device*/, VkImage /*image*/,
                                                       VkMemoryRequirements* requirements) {
    *requirements = kRequirements;
  }
  static VKAPI_ATTR void VKAPI_CALL
  planned_image_requirements(VkDevice /*device*/, const VkDeviceImageMemoryRequirements* /*info*/,
                             VkMemoryRequirements2* requirements) {
    requirements->memoryRequirements = kRequirements;
  }
  static VKAPI_ATTR void VKAPI_CALL
  planned_buffer_requirements(VkDevice /*device*/, const VkDeviceBufferMemoryRequirements* /*info*/,
                              VkMemoryRequirements2* requirements) {
    requirements->memoryRequirements = kRequirements;
  }

  static VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device,
                                                      const VkDescriptorSetAllocateInfo* info,
                                                      VkDescriptorSet* sets) {
    for (std::uint32_t i = 0; i < info->descriptorSetCount; ++i) {
      sets[i] = new_handle<VkDescriptorSet>(self(device));
    }
    return VK_SUCCESS;
  }

  // Commands that are recorded.
  static VKAPI_ATTR void VKAPI_CALL begin_label(VkCommandBuffer commands,
                                                const VkDebugUtilsLabelEXT* label) {
    self(commands).pass_ = label->pLabelName;
  }

  static VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer commands,
                                                  VkPipelineBindPoint /*point*/,
                                                  VkPipeline pipeline) {
    self(commands).bound_ = pipeline;
  }

  static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, std::uint32_t x,
                                             std::uint32_t y, std::uint32_t z) {
    RecordingDevice& recording = self(commands);
    recording.dispatches_.push_back({recording.pass_, recording.bound_, x, y, z});
  }

  template <typename Function>
  static PFN_vkVoidFunction erased(Function function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
  }

  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice /*device*/,
                                                                  const char* name) {
    const std::pair<const char*, PFN_vkVoidFunction> own[] = {
        {"vkCreateShaderModule", erased(create_module)},
        {"vkCreateSampler", erased(create_sampler)},
        {"vkCreateDescriptorSetLayout", erased(create_set_layout)},
        {"vkCreatePipelineLayout", erased(create_pipeline_layout)},
        {"vkCreateComputePipelines", erased(create_pipelines)},
        {"vkAllocateMemory", erased(allocate_memory)},
        {"vkMapMemory", erased(map_memory)},
        {"vkGetBufferMemoryRequirements", erased(buffer_requirements)},
        {"vkGetImageMemoryRequirements", erased(image_requirements)},
        {"vkGetDeviceImageMemoryRequirements", erased(planned_image_requirements)},
        {"vkGetDeviceBufferMemoryRequirements", erased(planned_buffer_requirements)},
        {"vkAllocateDescriptorSets", erased(allocate_sets)},
        {"vkCmdBeginDebugUtilsLabelEXT", erased(begin_label)},
        {"vkCmdBindPipeline", erased(bind_pipeline)},
        {"vkCmdDispatch", erased(dispatch)},
    };
    for (const auto& [own_name, function] : own) {
      if (std::strcmp(name, own_name) == 0) {
        return function;
      }
    }
#define ALCOVE_NOTHING(function) \
  if (std::strcmp(name, #function) == 0) return erased(Nothing<PFN_##function>::call);
    ALCOVE_FRAMEGRAPH_DEVICE_FUNCTIONS(ALCOVE_NOTHING)
    ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(ALCOVE_NOTHING)
#undef ALCOVE_NOTHING
    return nullptr;
  }

  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                    const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
      return erased(device_function);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceMemoryProperties") == 0) {
      return erased(memory_properties);
    }
    return vkGetInstanceProcAddr(instance, name);
  }
};

RecordingDevice::RecordingDevice(const NullDevice& device) : device_(device) {}
RecordingDevice::~RecordingDevice() = default;

framegraph::DeviceHandles RecordingDevice::handles() {
  framegraph::DeviceHandles handles;
  handles.instance = device_.instance;
  handles.physical_device = device_.physical_device;
  handles.device = reinterpret_cast<VkDevice>(this);
  handles.get_instance_proc_addr = RecordingFunctions::instance_function;
  handles.queues[0].family = 0;
  handles.debug_utils = true;  // labels name the pass of a dispatch
  return handles;
}

VkCommandBuffer RecordingDevice::commands() { return reinterpret_cast<VkCommandBuffer>(this); }

VkImage RecordingDevice::next_image() { return RecordingFunctions::new_handle<VkImage>(*this); }

std::vector<RecordedDispatch> RecordingDevice::take_dispatches() {
  return std::exchange(dispatches_, {});
}

const CompiledShader* RecordingDevice::compiled(VkPipeline pipeline) const {
  const auto found = compiled_.find(pipeline);
  return found == compiled_.end() ? nullptr : &found->second;
}

}  // namespace alcove::sample
