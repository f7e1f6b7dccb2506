#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::framegraph {

const char* load(VulkanFunctions& functions, PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                 VkInstance instance, VkDevice device) {
  if (get_instance_proc_addr == nullptr) return "vkGetInstanceProcAddr";
#define ALCOVE_LOAD(name)                                                                 \
  functions.name = reinterpret_cast<PFN_##name>(get_instance_proc_addr(instance, #name)); \
  if (functions.name == nullptr) return #name;
  ALCOVE_FRAMEGRAPH_INSTANCE_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
  const PFN_vkGetDeviceProcAddr get = functions.vkGetDeviceProcAddr;
#define ALCOVE_LOAD(name)                                            \
  functions.name = reinterpret_cast<PFN_##name>(get(device, #name)); \
  if (functions.name == nullptr) return #name;
  ALCOVE_FRAMEGRAPH_DEVICE_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
#define ALCOVE_LOAD(name) functions.name = reinterpret_cast<PFN_##name>(get(device, #name));
  ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(ALCOVE_LOAD)
#undef ALCOVE_LOAD
  return nullptr;
}

}  // namespace alcove::framegraph
