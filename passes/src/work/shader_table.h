// The SPIR-V modules that are embedded in the library, and the tables that their shaders look up.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "alcove/passes/kernels.h"

namespace alcove::passes {

struct ShaderSource {
  std::string_view name;                // for error sentences
  std::span<const std::uint32_t> code;  // words of the SPIR-V module
  // Contents of the shader's storage buffer. Empty if the shader has none.
  std::span<const std::uint32_t> table = {};
};

[[nodiscard]] ShaderSource shader_source(Shader shader);

}  // namespace alcove::passes
