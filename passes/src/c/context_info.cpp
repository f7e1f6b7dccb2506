#include "c/context_info.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "c/host.h"

namespace alcove::passes {

namespace {

tl::unexpected<Error> unsupported(std::string message) {
  return tl::unexpected(Error{std::move(message), ALCOVE_ERROR_UNSUPPORTED});
}

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version));
}

struct Features {
  bool synchronization2 = false;
  bool write_without_format = false;
  bool has_features2 = false;
  bool ends = true;
};

// Returns which of the needed features are enabled in a chain of feature structs, the kind of chain
// that vkCreateDevice takes and vkGetPhysicalDeviceFeatures2 fills. Its structs may have any order.
Features features_in(const void* chain) {
  constexpr int kMostStructs = 1000;  // Vulkan allows each type once, and has a few hundred
  Features all;
  int count = 0;
  for (auto* next = static_cast<const VkBaseInStructure*>(chain); next != nullptr;
       next = next->pNext) {
    if (++count > kMostStructs) return {.ends = false};
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2) {
      const auto* core = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(next);
      all.has_features2 = true;
      all.write_without_format |= core->features.shaderStorageImageWriteWithoutFormat != VK_FALSE;
    }
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
      const auto* vulkan13 = reinterpret_cast<const VkPhysicalDeviceVulkan13Features*>(next);
      all.synchronization2 |= vulkan13->synchronization2 != VK_FALSE;
    }
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES) {
      const auto* alone = reinterpret_cast<const VkPhysicalDeviceSynchronization2Features*>(next);
      all.synchronization2 |= alone->synchronization2 != VK_FALSE;
    }
  }
  return all;
}

Result check_features(const Features& features, std::string_view who, const char* remedy) {
  if (!features.ends)
    return invalid(std::string(who) +
                   " is a chain of structs that does not end; end it with null.");
  if (!features.has_features2) {
    return invalid(std::string(who) +
                   " has no VkPhysicalDeviceFeatures2, by its sType; add one to the chain, with "
                   "what vkCreateDevice received as pEnabledFeatures.");
  }
  const char* missing = !features.synchronization2
                            ? "synchronization2 (of Vulkan 1.3 or VK_KHR_synchronization2)"
                        : !features.write_without_format ? "shaderStorageImageWriteWithoutFormat"
                                                         : nullptr;
  if (missing == nullptr) return {};
  return unsupported(std::string(who) + " has no feature " + missing + ", which is needed; " +
                     remedy + ".");
}

template <typename Function>
Function instance_function(const AlcoveContextInfo& info, const char* name) {
  return reinterpret_cast<Function>(info.get_instance_proc_addr(info.instance, name));
}

Result check_device(const AlcoveContextInfo& info) {
  const auto get_properties =
      instance_function<PFN_vkGetPhysicalDeviceProperties>(info, "vkGetPhysicalDeviceProperties");
  const auto get_features =
      instance_function<PFN_vkGetPhysicalDeviceFeatures2>(info, "vkGetPhysicalDeviceFeatures2");
  const auto get_families = instance_function<PFN_vkGetPhysicalDeviceQueueFamilyProperties2>(
      info, "vkGetPhysicalDeviceQueueFamilyProperties2");
  if (get_properties == nullptr || get_features == nullptr || get_families == nullptr) {
    return unsupported(
        "The instance is older than Vulkan 1.2; create it with a "
        "VkApplicationInfo::apiVersion of at least VK_API_VERSION_1_2.");
  }
  VkPhysicalDeviceProperties properties{};
  get_properties(info.physical_device, &properties);
  const std::string name = std::string("The device '") + properties.deviceName + "'";
  if (properties.apiVersion < VK_API_VERSION_1_2) {
    return unsupported(name + " has Vulkan " + version_text(properties.apiVersion) +
                       ", and at least 1.2 is needed; choose another or update its driver.");
  }
  // A device without Vulkan 1.3 and without VK_KHR_synchronization2 leaves this struct as it is:
  // the feature stays false.
  VkPhysicalDeviceSynchronization2Features synchronization2{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
  VkPhysicalDeviceFeatures2 has{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                .pNext = &synchronization2};
  get_features(info.physical_device, &has);
  if (auto valid =
          check_features(features_in(&has), name, "choose another device or update its driver");
      !valid)
    return valid;
  if (info.enabled_features != nullptr) {
    if (auto valid = check_features(features_in(info.enabled_features),
                                    "AlcoveContextInfo::enabled_features",
                                    "enable it when the device is created");
        !valid)
      return valid;
  }
  std::uint32_t count = 0;
  get_families(info.physical_device, &count, nullptr);
  std::vector<VkQueueFamilyProperties2> families(
      count, {.sType = VK_STRUCTURE_TYPE_QUEUE_FAMILY_PROPERTIES_2});
  get_families(info.physical_device, &count, families.data());
  if (info.queue_family >= count) {
    return invalid("AlcoveContextInfo::queue_family is " + std::to_string(info.queue_family) +
                   ", but the device has " + std::to_string(count) + " families.");
  }
  const VkQueueFamilyProperties& family = families[info.queue_family].queueFamilyProperties;
  if ((family.queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
    return invalid("Queue family " + std::to_string(info.queue_family) +
                   " has no VK_QUEUE_COMPUTE_BIT; give a family that has it.");
  }
  if (info.timestamps != VK_FALSE && family.timestampValidBits == 0) {
    return unsupported("Queue family " + std::to_string(info.queue_family) +
                       " has no timestamps; set AlcoveContextInfo::timestamps to VK_FALSE.");
  }
  return {};
}

}  // namespace

Result check(const AlcoveContextInfo* info) {
  if (info == nullptr) return invalid("There is no AlcoveContextInfo.");
  if (auto valid = check_size(info->struct_size, sizeof *info, "AlcoveContextInfo"); !valid)
    return valid;
  const std::pair<const char*, bool> needed[] = {
      {"instance", info->instance != VK_NULL_HANDLE},
      {"physical_device", info->physical_device != VK_NULL_HANDLE},
      {"device", info->device != VK_NULL_HANDLE},
      {"get_instance_proc_addr", info->get_instance_proc_addr != nullptr}};
  for (const auto& [name, is_set] : needed)
    if (!is_set) return invalid(std::string("AlcoveContextInfo::") + name + " is null.");
  if (info->frames_in_flight < 1 || info->frames_in_flight > ALCOVE_MAX_FRAMES_IN_FLIGHT) {
    return invalid("AlcoveContextInfo::frames_in_flight is " +
                   std::to_string(info->frames_in_flight) + "; it must be 1 to " +
                   std::to_string(ALCOVE_MAX_FRAMES_IN_FLIGHT) + ".");
  }
  return check_device(*info).and_then([&] { return check_memory(*info); });
}

}  // namespace alcove::passes
