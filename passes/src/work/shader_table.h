// The SPIR-V modules that are embedded in the library, their interfaces, and the tables that their
// shaders look up.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove_work.h"
#include "alcove/passes/error.h"
#include "work/shader_interface.h"

namespace alcove::passes {

// The compute shaders of the library. Each is a file in shaders/, or a variant of a file that is
// compiled with other preprocessor definitions.
enum class Shader : std::uint8_t {
  surface,
  gtao,
  gtao_bent,
  gtao_specular,
  gtao_bent_specular,
  reconstruct,
  reconstruct_bent,
  reconstruct_specular,
  reconstruct_bent_specular,
  reconstruct_half,
  reconstruct_half_bent,
  reconstruct_half_specular,
  reconstruct_half_bent_specular,
  upsample,
  upsample_bent,
  upsample_specular,
  upsample_bent_specular,
  resolve_depth,
  halve_depth,
  mask_depth,
  mask_depth_integer,
  multi_bounce,
  gtso,
  inspect,
  count,
};
inline constexpr std::size_t kShaderCount = static_cast<std::size_t>(Shader::count);

// A value for a specialisation constant of a shader, by the constant's name in GLSL.
struct NamedConstant {
  std::string_view name;
  std::uint32_t value = 0;  // of a bool: 0 or 1
};

struct ShaderSource {
  std::string_view name = {};           // a literal
  std::span<const std::uint32_t> code;  // words of the SPIR-V module
  ShaderInterface interface;
  // Contents of the shader's storage buffer. Empty if the shader has none.
  std::span<const std::uint32_t> table = {};
};

[[nodiscard]] ShaderSource shader_source(Shader shader);

// Returns the shader of a name, or Shader::count.
[[nodiscard]] Shader shader_of_name(std::string_view name);

[[nodiscard]] const ShaderInterface& shader_interface(Shader shader);

// Returns the element of `given` whose name is `name`, or null. Looks at the index `expected`
// first, because lists usually have the order of the shader's declarations.
template <typename Element>
const Element* find_named(std::span<const Element> given, std::string_view name,
                          std::size_t expected) {
  if (expected < given.size() && given[expected].name == name) return &given[expected];
  const auto found = std::ranges::find(given, name, &Element::name);
  return found == given.end() ? nullptr : &*found;
}

// Writes the values of the specialisation constants of `shader` to `values`, ascending by id, and
// returns their number. Error: a constant that has no value in the list.
[[nodiscard]] tl::expected<std::uint32_t, Error> resolve_constants(
    Shader shader, std::span<const NamedConstant> given, std::span<AlcoveWorkConstant> values);

}  // namespace alcove::passes
