#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "gpu/gpu.h"
#include "viewer/window.h"

namespace alcove::sample {

// Dear ImGui on a window: its input, and a pass that draws it. One at a time.
class Gui {
 public:
  // `format` is the window's. Both references must outlive it.
  [[nodiscard]] static tl::expected<std::unique_ptr<Gui>, std::string> create(Gpu& gpu,
                                                                              Window& window,
                                                                              VkFormat format);
  // The device must have finished with it.
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // What is called of ImGui between these two is drawn by the next frames that add() is called for.
  void begin();
  void end();
  // Adds the pass that draws it over `target`, and returns the drawn version.
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
  bool on_window_ = false;                   // ImGui's two parts are there
  bool on_device_ = false;
};

}  // namespace alcove::sample
