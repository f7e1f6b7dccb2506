#pragma once

#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace alcove::sample {

// A shader module that exists while pipelines are created from it, and is destroyed with this
// object. `result` is the result of its creation.
struct ShaderModule {
  VkDevice device;
  VkShaderModule module = VK_NULL_HANDLE;
  VkResult result;

  ShaderModule(VkDevice on, std::span<const uint32_t> code) : device(on) {
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = code.size_bytes(),
                                        .pCode = code.data()};
    result = vkCreateShaderModule(device, &info, nullptr, &module);
  }
  ~ShaderModule() { vkDestroyShaderModule(device, module, nullptr); }
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;
};

// The shader modules of a graphics pipeline, which exist while the pipeline is created. `result` is
// that of the first failure, if any.
struct ShaderStages {
  ShaderModule vertex;
  ShaderModule fragment;
  VkResult result;
  std::array<VkPipelineShaderStageCreateInfo, 2> infos;

  // Creates both modules. `fragment_constants` specialises the fragment shader; it may be null, and
  // must outlive this object.
  ShaderStages(VkDevice device, std::span<const uint32_t> vertex_code,
               std::span<const uint32_t> fragment_code,
               const VkSpecializationInfo* fragment_constants = nullptr)
      : vertex(device, vertex_code),
        fragment(device, fragment_code),
        result(std::min(vertex.result, fragment.result)),
        infos{{{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_VERTEX_BIT,
                .module = vertex.module,
                .pName = "main"},
               {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                .module = fragment.module,
                .pName = "main",
                .pSpecializationInfo = fragment_constants}}} {}
};

}  // namespace alcove::sample
