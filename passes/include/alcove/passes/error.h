// The error of the C++ interface of the passes.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>

namespace alcove::passes {

// The reason why a pass could not be added. `message` is a sentence. `result` is that of the Vulkan
// call that failed, or VK_ERROR_FEATURE_NOT_PRESENT if the device lacks a function or its limits
// are too small.
struct Error {
  std::string message;
  VkResult result = VK_SUCCESS;
};

}  // namespace alcove::passes
