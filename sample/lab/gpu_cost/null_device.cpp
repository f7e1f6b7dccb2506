#include "gpu_cost/null_device.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "gpu_cost/silent_standard_error.h"

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
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().filename().string().starts_with("radeon_icd")) {
        found.push_back(entry.path().string());
      }
    }
    if (!found.empty()) {
      return *std::ranges::min_element(found);
    }
  }
  return std::nullopt;
}

// Sets an environment variable during the object's lifetime.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) {
      before_ = before;
    }
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
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

VkResult create_device(NullDevice& made) {
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
  return vkCreateDevice(made.physical_device, &info, nullptr, &made.device);
}

}  // namespace

tl::expected<NullDevice, std::string> create_null_device(std::string_view family) {
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
  NullDevice made;
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "alcove",
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pApplicationInfo = &application};
  std::uint32_t count = 1;
  if (vkCreateInstance(&info, nullptr, &made.instance) != VK_SUCCESS ||
      vkEnumeratePhysicalDevices(made.instance, &count, &made.physical_device) < VK_SUCCESS ||
      count == 0 || !has_executable_properties(made.physical_device) ||
      create_device(made) != VK_SUCCESS) {
    return Failure("Mesa's AMD driver (RADV, " + *manifest + ") has no device of the family " +
                   std::string(family) + ".");
  }
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(made.physical_device, &properties);
  made.name = properties.deviceName;
  return made;
}

}  // namespace alcove::sample
