#include "viewer/window.h"

// GLFW declares its Vulkan functions only if Vulkan's header, which window.h has, comes before.
#include <GLFW/glfw3.h>

#include <cstdint>

#include "gpu/vulkan_device.h"

namespace alcove::sample {
namespace {

// Returns GLFW's own description of the last failure.
std::string reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason is given";
}

Failure no_window() {
  return Failure("There is no display to open a window on (" + reason() +
                 "); `alcove render` needs none.");
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(VkExtent2D size, const std::string& title) {
  if (glfwInit() != GLFW_TRUE) return no_window();
  std::unique_ptr<Window> made(new Window);
  if (glfwVulkanSupported() != GLFW_TRUE) {
    return Failure("No Vulkan driver here can present to a window (" + reason() +
                   "); `alcove render` needs none.");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  made->window_ = glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height),
                                   title.c_str(), nullptr, nullptr);
  if (made->window_ == nullptr) return no_window();
  glfwSetWindowUserPointer(made->window_, made.get());
  glfwSetKeyCallback(made->window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_PRESS)
      static_cast<Window*>(glfwGetWindowUserPointer(window))->pressed_keys_.push_back(key);
  });
  glfwSetDropCallback(made->window_, [](GLFWwindow* window, int count, const char** paths) {
    auto& files = static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped_files_;
    files.insert(files.end(), paths, paths + count);
  });
  return made;
}

Window::~Window() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

std::vector<const char*> Window::instance_extensions() {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return {names, names + count};
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(instance, window_, nullptr, &surface);
  if (result != VK_SUCCESS) {
    return Failure("Vulkan cannot present to the window (" + std::string(result_name(result)) +
                   ").");
  }
  return surface;
}

void Window::show() { glfwShowWindow(window_); }

void Window::poll() {
  pressed_keys_.clear();
  glfwPollEvents();
  constexpr double kSeconds = 0.1;
  if (const VkExtent2D now = size(); now.width == 0 || now.height == 0)
    glfwWaitEventsTimeout(kSeconds);
}

bool Window::is_closed() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

VkExtent2D Window::size() const {
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) return {0, 0};
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void Window::resize(VkExtent2D size) {
  glfwSetWindowSize(window_, static_cast<int>(size.width), static_cast<int>(size.height));
}

float Window::content_scale() const {
  float x = 1.0f;
  float y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return x;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::copy_to_clipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

}  // namespace alcove::sample
