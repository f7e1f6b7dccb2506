#include "vulkan/vulkan_error.h"

#include <utility>

namespace alcove::passes {

AlcoveResult error_code(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return ALCOVE_ERROR_OUT_OF_HOST_MEMORY;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
      return ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY;
    case VK_ERROR_DEVICE_LOST:
      return ALCOVE_ERROR_DEVICE_LOST;
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return ALCOVE_ERROR_UNSUPPORTED;
    default:
      return ALCOVE_ERROR_VULKAN;
  }
}

tl::unexpected<Error> creation_error(std::string_view what, VkResult result) {
  Error error{"The occlusion passes could not create " + std::string(what) + ".",
              error_code(result), result};
  if (error.code == ALCOVE_ERROR_OUT_OF_HOST_MEMORY)
    error.message += " The host is out of memory.";
  else if (error.code == ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY)
    error.message += " The device is out of memory.";
  else if (error.code != ALCOVE_ERROR_UNSUPPORTED)
    error.message += " Vulkan's result is " + std::to_string(result) + ".";
  return tl::unexpected(std::move(error));
}

}  // namespace alcove::passes
