#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/result.h"

struct GLFWwindow;

namespace alcove::sample {

// A window on the display, hidden until show(). Only one may exist at a time, on the main thread.
class Window {
 public:
  // The error says why no window can be opened.
  [[nodiscard]] static Result<std::unique_ptr<Window>> create(VkExtent2D size,
                                                              const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // The extensions that a Vulkan instance needs to present to a window.
  [[nodiscard]] static std::vector<const char*> instance_extensions();
  [[nodiscard]] Result<VkSurfaceKHR> create_surface(VkInstance instance) const;

  void show();
  // Processes the events since the last call. Waits for an event if the window is minimised.
  void poll();
  bool is_closed() const;
  void close();
  // The size in pixels; 0x0 if the window is minimised.
  VkExtent2D size() const;
  void resize(VkExtent2D size);
  float content_scale() const;
  // The GLFW codes of the key presses that the most recent poll() processed, in order.
  const std::vector<int>& pressed_keys() const { return pressed_keys_; }
  // The paths of the files that were dropped on the window since the last call, in order.
  std::vector<std::string> take_dropped_files() { return std::exchange(dropped_files_, {}); }
  void set_title(const std::string& title);
  void copy_to_clipboard(const std::string& text);
  GLFWwindow* handle() const { return window_; }

 private:
  Window() = default;
  GLFWwindow* window_ = nullptr;
  std::vector<int> pressed_keys_;
  std::vector<std::string> dropped_files_;
};

}  // namespace alcove::sample
