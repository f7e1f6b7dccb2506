#include "gpu/vulkan_device.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace alcove::sample {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
// The environment variables that make validation layers check synchronisation between queue
// submissions too: of layers 1.3, and of layers 1.4, which do not know the first.
constexpr std::pair<const char*, const char*> kQueueSubmitChecks[] = {
    {"VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT"},
    {"VK_KHRONOS_VALIDATION_SYNCVAL_SUBMIT_TIME_VALIDATION", "true"}};

constexpr VkApplicationInfo kApplication{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .pApplicationName = "alcove",
                                         .apiVersion = VK_API_VERSION_1_3};

using Failure = tl::unexpected<std::string>;

Failure failure(std::string what, VkResult result) {
  return Failure(std::move(what) + " (" + std::string(result_name(result)) + ").");
}

// The structures of the Vulkan 1.3 features that Alcove uses, as a pNext chain.
struct Features {
  VkPhysicalDeviceVulkan13Features v13{.sType =
                                           VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
  VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                .pNext = &v12};
};

std::uint32_t find_queue_family(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & kNeeded) == kNeeded) return i;
  return UINT32_MAX;
}

std::string missing_features(VkPhysicalDevice device, std::uint32_t api_version) {
  if (api_version < VK_API_VERSION_1_3) return "Vulkan 1.3";
  Features has;
  vkGetPhysicalDeviceFeatures2(device, &has.all);
  const std::pair<VkBool32, const char*> needed[] = {
      {has.v13.synchronization2, "synchronization2"},
      {has.v13.dynamicRendering, "dynamicRendering"},
      {has.v12.timelineSemaphore, "timelineSemaphore"},
      {has.v12.hostQueryReset, "hostQueryReset"},
      {has.all.features.shaderStorageImageWriteWithoutFormat,
       "shaderStorageImageWriteWithoutFormat"},
      {find_queue_family(device) != UINT32_MAX, "a queue for both graphics and compute"},
  };
  std::string missing;
  for (const auto& [present, name] : needed)
    if (!present) missing += (missing.empty() ? "" : ", ") + std::string(name);
  return missing;
}

std::string driver_name(VkPhysicalDevice device) {
  VkPhysicalDeviceDriverProperties driver{.sType =
                                              VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device, &properties);
  return std::string(driver.driverName) + " " + driver.driverInfo;
}

DeviceSummary summarise(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device, &properties);
  return {.name = properties.deviceName,
          .driver = driver_name(device),
          .api_version = properties.apiVersion,
          .type = properties.deviceType,
          .missing = missing_features(device, properties.apiVersion)};
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance, &count, devices.data());
  devices.resize(count);
  return devices;
}

int preference(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 3;
  }
}

}  // namespace

std::string_view result_name(VkResult result) {
  constexpr std::pair<VkResult, std::string_view> kNames[] = {
      {VK_SUCCESS, "VK_SUCCESS"},
      {VK_TIMEOUT, "VK_TIMEOUT"},
      {VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY"},
      {VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY"},
      {VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED"},
      {VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST"},
      {VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT"},
      {VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT"},
      {VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT"},
      {VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER"},
      {VK_ERROR_OUT_OF_DATE_KHR, "VK_ERROR_OUT_OF_DATE_KHR"}};
  const auto found =
      std::ranges::find(kNames, result, &std::pair<VkResult, std::string_view>::first);
  return found == std::end(kNames) ? "a Vulkan error" : found->second;
}

tl::unexpected<std::string> too_large(const std::string& what, VkDeviceSize bytes,
                                      const VulkanDevice& device) {
  return tl::unexpected("The device gives no memory for " + what + ": it takes " +
                        std::to_string(bytes) + " bytes, and " +
                        std::to_string(device.max_allocation()) +
                        " are its limit for one allocation; choose another device with --device or "
                        "make the scene smaller.");
}

tl::unexpected<std::string> device_failure(const std::string& what, VkResult result) {
  const bool out_of_memory =
      result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY;
  return failure("The device could not " + what +
                     (out_of_memory ? ": memory is full; make the image smaller with --size" : ""),
                 result);
}

tl::expected<void, std::string> check(VkResult result, const std::string& what) {
  if (result != VK_SUCCESS) return device_failure(what, result);
  return {};
}

VKAPI_ATTR VkBool32 VKAPI_CALL VulkanDevice::receive_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/, VkDebugUtilsMessageTypeFlagsEXT /*types*/,
    const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  static_cast<VulkanDevice*>(self)->messages_.emplace_back(data->pMessage);
  return VK_FALSE;
}

tl::expected<void, std::string> VulkanDevice::create_instance(const DeviceOptions& options) {
  std::vector<const char*> extensions = options.surface_extensions;
  std::vector<const char*> layers;
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
      .pfnUserCallback = receive_message,
      .pUserData = this};
  const VkValidationFeatureEnableEXT checks[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = checks};
  if (options.validation) {
#ifndef _WIN32
    for (const auto& [variable, value] : kQueueSubmitChecks) setenv(variable, value, 1);
#endif
    // Under wine the layer is one of the host's, which VK_INSTANCE_LAYERS names; wine knows no
    // layers.
    if (std::getenv("ALCOVE_LAYERS_OF_THE_HOST") == nullptr) layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  VkApplicationInfo application = kApplication;
  if (options.vulkan12) application.apiVersion = VK_API_VERSION_1_2;
  const VkInstanceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = options.validation ? &features : nullptr,
      .pApplicationInfo = &application,
      .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
      .ppEnabledLayerNames = layers.data(),
      .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
      .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_LAYER_NOT_PRESENT) {
    return Failure(
        "The Khronos validation layer is not installed; on Debian, install the package "
        "vulkan-validationlayers.");
  }
  if (result != VK_SUCCESS) {
    return failure(
        "No Vulkan 1.3 instance could be created; install a Vulkan driver (on Debian, "
        "mesa-vulkan-drivers brings a software one)",
        result);
  }
  if (options.validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    create(instance_, &messenger, nullptr, &messenger_);
  }
  return {};
}

tl::expected<void, std::string> VulkanDevice::choose_physical_device(int index) {
  const std::vector<VkPhysicalDevice> devices = physical_devices(instance_);
  if (devices.empty()) {
    return Failure(
        "No Vulkan device was found; install a driver (on Debian, mesa-vulkan-drivers brings a "
        "software one).");
  }
  if (index >= static_cast<int>(devices.size())) {
    return Failure("There is no Vulkan device " + std::to_string(index) + ": the last one is " +
                   std::to_string(devices.size() - 1) + "; `alcove doctor` lists them.");
  }
  if (index >= 0) {
    physical_device_ = devices[static_cast<std::size_t>(index)];
    if (const DeviceSummary summary = summarise(physical_device_); !summary.missing.empty())
      return Failure("The device " + summary.name + " lacks " + summary.missing + ".");
    return {};
  }
  int best = 4;
  std::string lacking;
  for (const VkPhysicalDevice device : devices) {
    const DeviceSummary summary = summarise(device);
    if (!summary.missing.empty()) {
      lacking += " " + summary.name + " lacks " + summary.missing + ".";
    } else if (preference(summary.type) < best) {
      best = preference(summary.type);
      physical_device_ = device;
    }
  }
  if (physical_device_ == VK_NULL_HANDLE)
    return Failure("No Vulkan device has what Alcove needs:" + lacking);
  return {};
}

tl::expected<void, std::string> VulkanDevice::create_device(const DeviceOptions& options) {
  vkGetPhysicalDeviceProperties(physical_device_, &properties_);
  vkGetPhysicalDeviceMemoryProperties(physical_device_, &memory_);
  VkPhysicalDeviceMaintenance3Properties limits{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &limits};
  vkGetPhysicalDeviceProperties2(physical_device_, &properties);
  max_allocation_ = limits.maxMemoryAllocationSize;
  driver_ = driver_name(physical_device_);
  queue_family_ = find_queue_family(physical_device_);
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = queue_family_,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  Features enabled;
  enabled.v13.synchronization2 = VK_TRUE;
  enabled.v13.dynamicRendering = VK_TRUE;
  enabled.v12.timelineSemaphore = VK_TRUE;
  enabled.v12.hostQueryReset = VK_TRUE;
  enabled.v12.separateDepthStencilLayouts = VK_TRUE;  // Every device of Vulkan 1.2 has it.
  enabled.all.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  VkPhysicalDeviceFeatures optional;
  vkGetPhysicalDeviceFeatures(physical_device_, &optional);
  // On Mesa's software device, anisotropic filtering reads nearly the whole texture for pixels with
  // a long footprint, so that it is turned off there.
  if (optional.samplerAnisotropy && properties_.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU) {
    enabled.all.features.samplerAnisotropy = VK_TRUE;
    max_anisotropy_ = properties_.limits.maxSamplerAnisotropy;
  }
  std::vector<const char*> extensions;
  if (!options.surface_extensions.empty()) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  VkPhysicalDeviceSynchronization2Features synchronization2{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
      .synchronization2 = VK_TRUE};
  if (options.vulkan12) {
    enabled.all.pNext = &synchronization2;
    extensions.push_back(VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME);
  }
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &enabled.all,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateDevice(physical_device_, &info, nullptr, &device_);
  if (result != VK_SUCCESS) {
    return failure("The device " + std::string(properties_.deviceName) + " could not be opened",
                   result);
  }
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  return {};
}

tl::expected<std::unique_ptr<VulkanDevice>, std::string> VulkanDevice::create(
    const DeviceOptions& options) {
  std::unique_ptr<VulkanDevice> device(new VulkanDevice);
  return device->create_instance(options)
      .and_then([&] { return device->choose_physical_device(options.index); })
      .and_then([&] { return device->create_device(options); })
      .map([&] { return std::move(device); });
}

VulkanDevice::~VulkanDevice() {
  if (device_ != VK_NULL_HANDLE) {
    vkDeviceWaitIdle(device_);
    vkDestroyDevice(device_, nullptr);
  }
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

VkResult VulkanDevice::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                                VkDeviceMemory& memory) const {
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = needs.size,
                                  .memoryTypeIndex = memory_type(needs.memoryTypeBits, flags)};
  if (info.memoryTypeIndex == UINT32_MAX) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return vkAllocateMemory(device_, &info, nullptr, &memory);
}

std::uint32_t VulkanDevice::memory_type(std::uint32_t type_bits,
                                        VkMemoryPropertyFlags flags) const {
  for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((type_bits >> i & 1u) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags)
      return i;
  return UINT32_MAX;
}

tl::expected<std::vector<DeviceSummary>, std::string> list_devices() {
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pApplicationInfo = &kApplication};
  VkInstance instance = VK_NULL_HANDLE;
  if (const VkResult result = vkCreateInstance(&info, nullptr, &instance); result != VK_SUCCESS)
    return failure("No Vulkan 1.3 instance could be created; install a Vulkan driver", result);
  std::vector<DeviceSummary> summaries;
  for (const VkPhysicalDevice device : physical_devices(instance))
    summaries.push_back(summarise(device));
  vkDestroyInstance(instance, nullptr);
  return summaries;
}

}  // namespace alcove::sample
