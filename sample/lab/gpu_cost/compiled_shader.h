// Statistics and code that a driver's compiler reports for a compute pipeline
// (VK_KHR_pipeline_executable_properties).
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <map>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

struct CompiledShader {
  std::uint32_t wave = 64;                   // invocations in a wave
  std::uint32_t group = 64;                  // invocations in a workgroup
  std::map<std::string, double> statistics;  // by the names that the driver gives
  std::map<std::string, std::string> texts;  // the compiler's representations, by name
};

// Reads what the compiler kept of a pipeline that was created with
// VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR and
// VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR.
[[nodiscard]] tl::expected<CompiledShader, std::string> read_compiled_shader(VkDevice device,
                                                                             VkPipeline pipeline);

}  // namespace alcove::sample
