// The embedded SPIR-V of each shader and what it binds after its parameters.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "alcove/passes/kernels.h"

namespace alcove::passes {

struct ShaderSource {
  std::span<const std::uint32_t> code;
  // One letter a binding from binding 1 on: 's' a sampled image, 'g' one with a
  // nearest sampler that clamps to the edge, 't' a storage image, and as the
  // last of them 'b' a storage buffer with `table`.
  std::string_view bindings;
  std::span<const std::uint32_t> table = {};
};

[[nodiscard]] const ShaderSource& shader_source(Shader shader);

}  // namespace alcove::passes
