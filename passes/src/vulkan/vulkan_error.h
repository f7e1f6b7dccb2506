// Errors of Vulkan's functions.
#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "alcove/passes/error.h"

namespace alcove::passes {

// Returns the code of a Vulkan result that is an error.
[[nodiscard]] AlcoveResult error_code(VkResult result);
// Returns the error for an object, such as "a sampler", that could not be created.
[[nodiscard]] tl::unexpected<Error> creation_error(std::string_view what, VkResult result);

}  // namespace alcove::passes
