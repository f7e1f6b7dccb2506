// The error of the passes, of their C++ interface and behind their C interface.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>

#include "alcove/alcove_result.h"

namespace alcove::passes {

// `message` is a sentence. `code` is what the functions of the C interface return for the error.
// `result` is that of the Vulkan call that failed, or VK_SUCCESS if none did.
struct Error {
  std::string message;
  AlcoveResult code = ALCOVE_ERROR_INVALID_INPUT;
  VkResult result = VK_SUCCESS;
};

}  // namespace alcove::passes
