// Reads the descriptor bindings and specialisation constants of a compute shader from its SPIR-V.
// The GLSL source is the only place where they are declared: the passes refer to them by their GLSL
// names.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace alcove::passes {

struct ShaderBinding {
  // Name of the GLSL variable, which points into the module. It is empty for a block without an
  // instance name.
  std::string_view name;
  std::uint32_t number = 0;  // layout(binding = number)
  // VK_DESCRIPTOR_TYPE_MAX_ENUM if read_shader_interface() does not know the variable's type.
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
  std::uint32_t access = 0;  // a combination of AlcoveWorkAccess

  bool is_image() const {
    return type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  }
};

struct ShaderConstant {
  std::string_view name;  // of the GLSL constant; it points into the module
  std::uint32_t id = 0;   // layout(constant_id = id)
};

struct ShaderInterface {
  std::vector<ShaderBinding> bindings;    // ascending by number
  std::vector<ShaderConstant> constants;  // ascending by id
};

// Returns the interface of `module`, the words of a valid SPIR-V module with debug names (OpName).
// The module must outlive the result. Bindings of all descriptor sets are listed together, because
// the shaders of this library only use set 0.
[[nodiscard]] ShaderInterface read_shader_interface(std::span<const std::uint32_t> module);

}  // namespace alcove::passes
