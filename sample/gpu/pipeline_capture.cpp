#include "gpu/pipeline_capture.h"

#include <cstdint>
#include <cstring>

namespace alcove::sample {
namespace {

std::vector<VkPipeline>& pipelines() {
  static std::vector<VkPipeline> all;
  return all;
}

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                std::uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* callbacks,
                                                VkPipeline* created) {
  std::vector<VkComputePipelineCreateInfo> capturing(infos, infos + count);
  for (VkComputePipelineCreateInfo& info : capturing)
    info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  const VkResult result =
      vkCreateComputePipelines(device, cache, count, capturing.data(), callbacks, created);
  if (result == VK_SUCCESS) pipelines().insert(pipelines().end(), created, created + count);
  return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
  return std::strcmp(name, "vkCreateComputePipelines") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(create_pipelines)
             : vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
  return std::strcmp(name, "vkGetDeviceProcAddr") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(device_function)
             : vkGetInstanceProcAddr(instance, name);
}

}  // namespace

PFN_vkGetInstanceProcAddr capturing_functions() { return instance_function; }

const std::vector<VkPipeline>& captured_pipelines() { return pipelines(); }

}  // namespace alcove::sample
