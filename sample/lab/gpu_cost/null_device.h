// A Vulkan device without a GPU: Mesa's RADV driver compiles pipelines for any AMD GPU, and reports
// their statistics and code (VK_KHR_pipeline_executable_properties).
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "alcove/alcove_work.h"
#include "support/result.h"

namespace alcove::sample {

// A device that can create pipelines and do nothing else. The driver cannot destroy it, so its
// handles live until the process ends.
struct NullDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::string compiler;  // name and version of the driver, whose compiler determines the costs
};

// Returns the device of the GPU family `family`, named as in the environment variable
// RADV_FORCE_FAMILY, which the first call creates. Environment variables of this process are set
// during the call, and no other thread may read them meanwhile. Errors: the driver is not
// installed, or does not support the family.
[[nodiscard]] Result<NullDevice> create_null_device(std::string_view family);

struct CompiledShader {
  std::uint32_t wave = 64;                   // invocations in a wave
  std::map<std::string, double> statistics;  // by the names that the driver gives
  std::map<std::string, std::string> texts;  // the compiler's representations, by name
};

// Compiles the pipeline of a dispatch. The result is kept until the process ends. Error: the driver
// rejects the pipeline, or reports nothing about it.
[[nodiscard]] Result<const CompiledShader*> compile_dispatch(const NullDevice& device,
                                                             const AlcoveWorkDispatch& dispatch);

}  // namespace alcove::sample
