// A Vulkan device as an engine for Vulkan 1.2 creates it: the instance requests version 1.2, and
// the device enables VK_KHR_synchronization2, but no other feature that Vulkan 1.3 made core. It
// runs under the validation layers.
#pragma once

#include <string>

#include "engine.h"

namespace alcove::passes {

class Vulkan12Device {
 public:
  explicit Vulkan12Device(bool has_synchronization2 = true);
  ~Vulkan12Device();
  Vulkan12Device(const Vulkan12Device&) = delete;
  Vulkan12Device& operator=(const Vulkan12Device&) = delete;

  const EngineDevice& handles() const { return handles_; }
  // Returns the messages of the validation layers so far.
  const std::string& messages() const { return messages_; }

 private:
  std::string messages_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  EngineDevice handles_;
};

}  // namespace alcove::passes
