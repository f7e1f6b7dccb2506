#pragma once

#include <vulkan/vulkan.h>

#include <vector>

namespace alcove::sample {

// Returns vkGetInstanceProcAddr of the loader with one change: compute pipelines keep the
// statistics of the driver's compiler (VK_KHR_pipeline_executable_properties), and
// captured_pipelines() lists them in the order of their creation. The device must have the feature
// enabled.
[[nodiscard]] PFN_vkGetInstanceProcAddr capturing_functions();
[[nodiscard]] const std::vector<VkPipeline>& captured_pipelines();

}  // namespace alcove::sample
