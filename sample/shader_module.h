#ifndef ALCOVE_SAMPLE_SHADER_MODULE_H_
#define ALCOVE_SAMPLE_SHADER_MODULE_H_

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>

namespace alcove::sample {

// A shader while pipelines are made of it; `result` says whether there is one.
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

}  // namespace alcove::sample

#endif  // ALCOVE_SAMPLE_SHADER_MODULE_H_
