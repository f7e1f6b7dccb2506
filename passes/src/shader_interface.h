// The descriptor bindings and specialisation constants of a compute shader, read from its SPIR-V.
// The GLSL file is their only declaration: the passes refer to them by the names that they have
// there, and types and numbers come from the module.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace alcove::passes {

struct ShaderBinding {
  // Name of the GLSL variable; it points into the module. Empty for a block without an instance
  // name.
  std::string_view name;
  std::uint32_t number = 0;  // layout(binding = number)
  // VK_DESCRIPTOR_TYPE_MAX_ENUM if read_shader_interface() does not know the variable's type.
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
};

struct ShaderConstant {
  std::string_view name;  // of the GLSL constant; it points into the module
  std::uint32_t id = 0;   // layout(constant_id = id)
};

struct ShaderInterface {
  std::vector<ShaderBinding> bindings;    // ascending by number
  std::vector<ShaderConstant> constants;  // ascending by id
};

// Returns the interface of `module`, the words of a valid SPIR-V module with names (OpName), which
// must outlive the result. Bindings of all descriptor sets are listed together; the shaders of this
// library use set 0 alone.
[[nodiscard]] ShaderInterface read_shader_interface(std::span<const std::uint32_t> module);

}  // namespace alcove::passes
