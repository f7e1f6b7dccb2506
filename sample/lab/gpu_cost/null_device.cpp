#include "gpu_cost/null_device.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The folders in which Linux distributions install the manifests of Vulkan drivers.
constexpr std::array<const char*, 3> kManifestFolders{
    "/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"};

std::optional<std::string> radv_manifest() {
  for (const char* folder : kManifestFolders) {
    std::error_code error;
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
      if (entry.path().filename().string().starts_with("radeon_icd"))
        found.push_back(entry.path().string());
    if (!found.empty()) return *std::ranges::min_element(found);
  }
  return std::nullopt;
}

// Discards the output on standard error during the object's lifetime, for drivers that print to it.
class SilentStandardError {
 public:
  SilentStandardError() : before_(dup(STDERR_FILENO)) {
    if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {
      dup2(nowhere, STDERR_FILENO);
      close(nowhere);
    }
  }
  ~SilentStandardError() {
    if (before_ >= 0) {
      dup2(before_, STDERR_FILENO);
      close(before_);
    }
  }
  SilentStandardError(const SilentStandardError&) = delete;
  SilentStandardError& operator=(const SilentStandardError&) = delete;

 private:
  int before_;
};

// Sets an environment variable during the object's lifetime.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

bool has_executable_properties(VkPhysicalDevice device) {
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executable{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = &executable};
  vkGetPhysicalDeviceFeatures2(device, &features);
  return executable.pipelineExecutableInfo == VK_TRUE;
}

VkResult create_device(NullDevice& null_device) {
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executable{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
      .pipelineExecutableInfo = VK_TRUE};
  const VkPhysicalDeviceFeatures2 features{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
      .pNext = &executable,
      .features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE, .shaderInt16 = VK_TRUE}};
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const char* extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = 1,
                                .ppEnabledExtensionNames = &extension};
  return vkCreateDevice(null_device.physical_device, &info, nullptr, &null_device.device);
}

double value_of(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
      return statistic.value.b32 != 0 ? 1.0 : 0.0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
      return static_cast<double>(statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
      return static_cast<double>(statistic.value.u64);
    default:
      return statistic.value.f64;
  }
}

VkDescriptorType descriptor_type(AlcoveBindingType type) {
  switch (type) {
    case ALCOVE_BINDING_TYPE_PARAMETERS:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case ALCOVE_BINDING_TYPE_TABLE:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case ALCOVE_BINDING_TYPE_SAMPLER:
      return VK_DESCRIPTOR_TYPE_SAMPLER;
    case ALCOVE_BINDING_TYPE_FETCHED_IMAGE:
      return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    default:
      return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  }
}

// Creates the pipeline of a dispatch, and returns whether it could. Its objects live as long as the
// device, until the process ends. Samplers are part of the layout, as alcove_work.h says: nearest
// and clamped.
bool create_pipeline(VkDevice device, const AlcoveWorkDispatch& dispatch, VkPipeline& pipeline) {
  const VkSamplerCreateInfo sampler_info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                         .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                         .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                         .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  VkSampler sampler = VK_NULL_HANDLE;
  AlcoveShader shader{};
  if (alcoveGetShader(dispatch.shader, &shader) != ALCOVE_SUCCESS ||
      vkCreateSampler(device, &sampler_info, nullptr, &sampler) != VK_SUCCESS)
    return false;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const AlcoveWorkBinding& binding :
       std::span(dispatch.bindings).first(dispatch.binding_count)) {
    const bool samples = binding.type == ALCOVE_BINDING_TYPE_SAMPLER;
    bindings.push_back({binding.number, descriptor_type(binding.type), 1,
                        VK_SHADER_STAGE_COMPUTE_BIT, samples ? &sampler : nullptr});
  }
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = dispatch.binding_count,
      .pBindings = bindings.data()};
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  const VkPipelineLayoutCreateInfo layout_info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = 1,
      .pSetLayouts = &set};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  const VkShaderModuleCreateInfo module_info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                             .codeSize = shader.code_size,
                                             .pCode = shader.code};
  VkShaderModule module = VK_NULL_HANDLE;
  if (vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set) != VK_SUCCESS ||
      vkCreatePipelineLayout(device, &layout_info, nullptr, &layout) != VK_SUCCESS ||
      vkCreateShaderModule(device, &module_info, nullptr, &module) != VK_SUCCESS)
    return false;
  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < dispatch.constant_count; ++i) {
    entries.push_back({dispatch.constants[i].id,
                       static_cast<std::uint32_t>(i * sizeof(AlcoveWorkConstant) +
                                                  offsetof(AlcoveWorkConstant, value)),
                       sizeof dispatch.constants[i].value});
  }
  const VkSpecializationInfo constants{dispatch.constant_count, entries.data(),
                                       dispatch.constant_count * sizeof(AlcoveWorkConstant),
                                       dispatch.constants};
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
               VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main",
                .pSpecializationInfo = &constants},
      .layout = layout};
  const SilentStandardError silent;  // ACO warns if it finds no disassembler for old GPUs
  return vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline) ==
         VK_SUCCESS;
}

// Reads what the compiler kept of a pipeline.
Result<CompiledShader> read_compiled_shader(VkDevice device, VkPipeline pipeline) {
  const auto load = [device](const char* name) { return vkGetDeviceProcAddr(device, name); };
  const auto get_properties = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
      load("vkGetPipelineExecutablePropertiesKHR"));
  const auto get_statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
      load("vkGetPipelineExecutableStatisticsKHR"));
  const auto get_texts = reinterpret_cast<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
      load("vkGetPipelineExecutableInternalRepresentationsKHR"));
  if (get_properties == nullptr || get_statistics == nullptr || get_texts == nullptr)
    return Failure("The device lacks VK_KHR_pipeline_executable_properties.");
  const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
  std::uint32_t count = 1;
  VkPipelineExecutablePropertiesKHR properties{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
  if (get_properties(device, &info, &count, &properties) < VK_SUCCESS || count == 0)
    return Failure("The driver reports no executable for a pipeline that it compiled.");
  CompiledShader shader;
  shader.wave = properties.subgroupSize;
  const VkPipelineExecutableInfoKHR executable{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
  get_statistics(device, &executable, &count, nullptr);
  std::vector<VkPipelineExecutableStatisticKHR> statistics(
      count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  get_statistics(device, &executable, &count, statistics.data());
  for (const VkPipelineExecutableStatisticKHR& statistic : statistics)
    shader.statistics[statistic.name] = value_of(statistic);
  get_texts(device, &executable, &count, nullptr);
  std::vector<VkPipelineExecutableInternalRepresentationKHR> texts(
      count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR});
  get_texts(device, &executable, &count, texts.data());
  std::vector<std::string> contents(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    contents[i].resize(texts[i].dataSize);
    texts[i].pData = contents[i].data();
  }
  get_texts(device, &executable, &count, texts.data());
  for (std::uint32_t i = 0; i < count; ++i)
    shader.texts[texts[i].name] = contents[i].substr(0, contents[i].find('\0'));
  return shader;
}

}  // namespace

Result<NullDevice> create_null_device(std::string_view family) {
  // Parts of one family share a device, and with it the pipelines that it has compiled.
  static std::map<std::string, NullDevice, std::less<>> known;
  if (const auto found = known.find(family); found != known.end()) return found->second;
  const auto manifest = radv_manifest();
  if (!manifest) {
    return Failure(
        "Mesa's AMD driver (RADV) is not installed; on Debian, install the package "
        "mesa-vulkan-drivers.");
  }
  // Vulkan loaders read VK_DRIVER_FILES; loaders before 1.3.207 read VK_ICD_FILENAMES instead.
  const ScopedVariable files("VK_DRIVER_FILES", *manifest);
  const ScopedVariable old_files("VK_ICD_FILENAMES", *manifest);
  const ScopedVariable forced("RADV_FORCE_FAMILY", std::string(family));
  const SilentStandardError silent;  // RADV warns that it does not conform
  NullDevice null_device;
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "alcove",
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pApplicationInfo = &application};
  std::uint32_t count = 1;
  if (vkCreateInstance(&info, nullptr, &null_device.instance) != VK_SUCCESS ||
      vkEnumeratePhysicalDevices(null_device.instance, &count, &null_device.physical_device) <
          VK_SUCCESS ||
      count == 0 || !has_executable_properties(null_device.physical_device) ||
      create_device(null_device) != VK_SUCCESS) {
    return Failure("Mesa's AMD driver (RADV, " + *manifest + ") has no device of the family " +
                   std::string(family) + ".");
  }
  VkPhysicalDeviceDriverProperties driver{.sType =
                                              VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &driver};
  vkGetPhysicalDeviceProperties2(null_device.physical_device, &properties);
  null_device.compiler = std::string(driver.driverName) + ", " + driver.driverInfo;
  return known[std::string(family)] = null_device;
}

Result<const CompiledShader*> compile_dispatch(const NullDevice& device,
                                               const AlcoveWorkDispatch& dispatch) {
  // The states of a frame, and settings that differ little, have most pipelines in common.
  static std::map<std::tuple<VkDevice, std::string, std::vector<std::uint32_t>>, CompiledShader>
      known;
  std::vector<std::uint32_t> constants;
  for (std::uint32_t i = 0; i < dispatch.constant_count; ++i)
    constants.push_back(dispatch.constants[i].value);
  const std::tuple key{device.device, std::string(dispatch.shader), std::move(constants)};
  if (const auto found = known.find(key); found != known.end()) return &found->second;
  VkPipeline pipeline = VK_NULL_HANDLE;
  if (!create_pipeline(device.device, dispatch, pipeline)) {
    return Failure("Mesa's AMD driver could not compile the shader '" +
                   std::string(dispatch.shader) + "'.");
  }
  ALCOVE_TRY(auto shader, read_compiled_shader(device.device, pipeline));
  return &known.emplace(key, std::move(shader)).first->second;
}

}  // namespace alcove::sample
