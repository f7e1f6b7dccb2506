// Samples the pixels of a view's inputs on the device, and reads the samples some frames later.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "alcove/alcove.h"
#include "alcove/passes/graph.h"
#include "diagnose/mistake_finder.h"
#include "vulkan/host_buffer.h"

namespace alcove::passes {

class PixelObserver {
 public:
  PixelObserver(const framegraph::DeviceHandles& device, const framegraph::VulkanFunctions& vk)
      : device_(device), vk_(vk) {}
  PixelObserver(const PixelObserver&) = delete;
  PixelObserver& operator=(const PixelObserver&) = delete;

  // Begins a frame. Reads the samples of the last frame that was recorded with this slot, and tells
  // `finder` what they show. If that frame has not finished on the device, its slot is reused.
  void collect(std::uint32_t slot, MistakeFinder& finder);
  // Adds the passes that sample a view. Its samples are read only if recorded() is called.
  [[nodiscard]] tl::expected<void, Error> add(framegraph::Graph& graph, Pipelines& pipelines,
                                              const AlcoveView& view, const ViewTextures& inputs,
                                              std::uint32_t slot);
  void recorded(std::uint32_t slot) { pending_.at(slot).recorded = pending_.at(slot).declared; }
  void discarded(std::uint32_t slot) { pending_.at(slot).recorded = false; }

 private:
  struct Pending {
    bool declared = false;
    bool recorded = false;
    InspectedFrame frame;
    std::unique_ptr<HostBuffer> buffer;
  };

  framegraph::DeviceHandles device_;
  const framegraph::VulkanFunctions& vk_;
  std::array<Pending, ALCOVE_MAX_FRAMES_IN_FLIGHT> pending_;
  std::vector<InspectedFrame> frames_;  // successive frames of a view, the newest first
  std::uint32_t serial_ = 0;            // of the frame that is recorded now
};

}  // namespace alcove::passes
