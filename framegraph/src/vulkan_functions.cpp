#include "alcove/framegraph/vulkan_functions.h"

#include <cstdio>
#include <initializer_list>

namespace alcove::framegraph {
namespace {

// Returns the function of this name, or its KHR or EXT version from before the function became
// core.
template <typename Get>
PFN_vkVoidFunction find(const Get& get, const char* name) {
  for (const char* suffix : {"", "KHR", "EXT"}) {
    char full[64];
    std::snprintf(full, sizeof full, "%s%s", name, suffix);
    if (const PFN_vkVoidFunction function = get(full)) return function;
  }
  return nullptr;
}

}  // namespace

const char* load(VulkanFunctions& functions, PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                 VkInstance instance, VkDevice device) {
  if (get_instance_proc_addr == nullptr) return "vkGetInstanceProcAddr";
  const auto of_instance = [&](const char* name) { return get_instance_proc_addr(instance, name); };
  const auto of_device = [&](const char* name) {
    return functions.vkGetDeviceProcAddr(device, name);
  };
#define ALCOVE_LOAD_FROM(get, name) functions.name = reinterpret_cast<PFN_##name>(find(get, #name));
#define ALCOVE_LOAD(name)             \
  ALCOVE_LOAD_FROM(of_instance, name) \
  if (functions.name == nullptr) return #name;
  ALCOVE_FRAMEGRAPH_INSTANCE_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
#define ALCOVE_LOAD(name)           \
  ALCOVE_LOAD_FROM(of_device, name) \
  if (functions.name == nullptr) return #name;
  ALCOVE_FRAMEGRAPH_DEVICE_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
#define ALCOVE_LOAD(name) ALCOVE_LOAD_FROM(of_device, name)
  ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
#undef ALCOVE_LOAD_FROM
  return nullptr;
}

}  // namespace alcove::framegraph
