#pragma once

#include <memory>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "support/result.h"
#include "viewer/window.h"

namespace alcove::sample {

// Dear ImGui for a window: it takes the input of the window and adds a pass that draws the widgets.
// Only one object may exist at a time.
class Gui {
 public:
  // `format` is the format of the window's images. Both references must outlive the object.
  [[nodiscard]] static Result<std::unique_ptr<Gui>> create(Gpu& gpu, Window& window,
                                                           VkFormat format);
  // The device must have finished all frames that draw the widgets.
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // ImGui functions are called between begin() and end(). The next calls of add() draw the result.
  void begin();
  void end();
  // Adds a pass that draws the widgets over `target`. Returns the version of the texture after it.
  [[nodiscard]] framegraph::Texture add(framegraph::Graph& graph, framegraph::Texture target);

 private:
  explicit Gui(const VulkanDevice& device) : device_(device) {}
  VkResult create_render_pass(VkFormat format);
  VkResult create_pool();
  void record(framegraph::RecordContext& context, framegraph::Texture target);

  const VulkanDevice& device_;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkFramebuffer> framebuffers_;  // by frame slot
  bool on_window_ = false;                   // ImGui's backends for GLFW and Vulkan are initialised
  bool on_device_ = false;
};

}  // namespace alcove::sample
