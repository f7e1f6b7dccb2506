// Reads back samples of a view's inputs, some frames after they were recorded, and counts the
// mistakes that they show.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alcove/alcove.h"
#include "c/failure.h"
#include "diagnose/inspect.h"
#include "vulkan/host_buffer.h"

namespace alcove::passes {

class PixelObserver {
 public:
  PixelObserver(const framegraph::DeviceHandles& device, const framegraph::VulkanFunctions& vk)
      : device_(device), vk_(vk) {}
  PixelObserver(const PixelObserver&) = delete;
  PixelObserver& operator=(const PixelObserver&) = delete;

  // Reads the samples of the last frame that was recorded with this slot. If that frame has not
  // finished on the device, counts it as a slot that was reused too early.
  void collect(std::uint32_t slot);
  // Adds the passes that sample a view. Its samples are read only if recorded() is called.
  [[nodiscard]] tl::expected<void, Failure> add(const Frame& frame, const AlcoveView& view,
                                                framegraph::Texture depth,
                                                framegraph::Texture normals, std::uint32_t slot);
  void recorded(std::uint32_t slot) { pending_.at(slot).recorded = pending_.at(slot).declared; }
  void discarded(std::uint32_t slot) { pending_.at(slot).recorded = false; }

  // Returns a line for each mistake that all inspected frames show, of which there are at least
  // three, or an empty text if there is none.
  [[nodiscard]] std::string describe() const;

 private:
  struct Pending {
    bool declared = false;
    bool recorded = false;
    std::uint32_t serial = 0;
    std::uint32_t id = 0;
    InspectedView view;
    std::unique_ptr<HostBuffer> buffer;
  };
  struct Counts {
    std::uint32_t id = 0;
    std::uint32_t frames = 0;
    std::array<std::uint32_t, static_cast<std::size_t>(Mistake::count)> seen{};
  };

  framegraph::DeviceHandles device_;
  const framegraph::VulkanFunctions& vk_;
  std::array<Pending, ALCOVE_MAX_FRAMES_IN_FLIGHT> pending_;
  std::vector<Counts> counts_;  // by view
  std::uint32_t serial_ = 0;
  std::uint32_t early_ = 0;  // slots that were recorded again before their frame had finished
};

}  // namespace alcove::passes
