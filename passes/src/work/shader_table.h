// The SPIR-V modules that are embedded in the library, their interfaces, and the tables that their
// shaders look up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include "alcove/alcove_work.h"
#include "alcove/passes/kernels.h"
#include "work/shader_interface.h"

namespace alcove::passes {

inline constexpr std::size_t kShaderCount = static_cast<std::size_t>(Shader::count);

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
