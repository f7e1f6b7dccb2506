// The descriptor bindings and specialisation constants of a compute shader. The GLSL source is the
// only place where they are declared: the build reads them from the compiled module
// (shader_files/read_shaders.cpp), and the passes refer to them by their GLSL names.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace alcove::passes {

struct ShaderBinding {
  // Name of the GLSL variable, a literal. It is empty for a block without an instance name.
  std::string_view name;
  std::uint32_t number = 0;  // layout(binding = number)
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
  std::uint32_t access = 0;  // a combination of AlcoveWorkAccess

  bool is_image() const {
    return type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  }
};

struct ShaderConstant {
  std::string_view name;  // of the GLSL constant
  std::uint32_t id = 0;   // layout(constant_id = id)
};

struct ShaderInterface {
  std::span<const ShaderBinding> bindings;    // of all descriptor sets, ascending by number
  std::span<const ShaderConstant> constants;  // ascending by id
};

}  // namespace alcove::passes
