// Checks the textures that a pass is given.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "alcove/passes/work.h"
#include "work/number_text.h"

namespace alcove::passes {

struct NamedInput {
  std::string_view name;
  framegraph::Texture texture;
};

// Returns an error that names the first input that is missing or that differs in size from the
// first input of the list.
[[nodiscard]] inline tl::expected<void, Error> check_inputs(
    const WorkList& list, std::string_view pass, std::initializer_list<NamedInput> inputs) {
  for (const NamedInput& input : inputs) {
    if (!input.texture) {
      return tl::unexpected(Error{"The pass " + std::string(pass) + " needs a texture of " +
                                  std::string(input.name) + "; it was given none."});
    }
    if (list.samples(input.texture) > 1) {
      return tl::unexpected(Error{
          "The pass " + std::string(pass) + " was given " + std::string(input.name) + " with " +
          std::to_string(list.samples(input.texture)) + " samples per pixel; resolve it first."});
    }
    const VkExtent2D size = list.size(input.texture);
    const VkExtent2D wanted = list.size(inputs.begin()->texture);
    if (size.width != wanted.width || size.height != wanted.height) {
      return tl::unexpected(Error{"The pass " + std::string(pass) + " was given " +
                                  std::string(input.name) + " of " + size_text(size) +
                                  " pixels and " + std::string(inputs.begin()->name) + " of " +
                                  size_text(wanted) + "; make them equal."});
    }
  }
  return {};
}

}  // namespace alcove::passes
