// Knows which views have converged: their images would not change with further frames.
#pragma once

#include <array>
#include <cstdint>

#include "alcove/alcove.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// Counts, for each view with AlcoveView::skip_converged, the frames that were recorded for an
// unchanged image. If more views are recorded than it has room for, it forgets the view that was
// not recorded for the longest time, which is then recorded again.
class StillViews {
 public:
  // Returns whether a frame has nothing to do for the view.
  [[nodiscard]] bool is_converged(const AlcoveView& view) const;
  // Observes a view of a frame that was recorded. `skipped` says that nothing was done for it.
  void observe(const AlcoveView& view, bool skipped);
  void drop(std::uint32_t id);
  // Returns the state of a view, with zeros for one that is not known.
  [[nodiscard]] AlcoveViewState state(std::uint32_t id) const;

 private:
  static constexpr std::size_t kImages = 12;
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::array<std::uint32_t, 4> place{};  // width, height, layer, samples
    bool operator==(const Image&) const = default;
  };
  // Everything that the image of a view depends on, except the contents of its inputs.
  struct Description {
    OcclusionSettings settings;
    std::array<float, 36> numbers{};  // the camera, and the scale and offset of motion vectors
    std::array<std::uint32_t, 20> choices{};
    std::array<Image, kImages> images{};
    bool operator==(const Description&) const = default;
  };
  struct View {
    std::uint32_t id = 0;
    std::uint32_t frames = 0;  // 0: the place is free
    std::uint32_t age = 0;     // views that were observed since this one
    bool skipped = false;
    Description description;
  };
  static Description describe(const AlcoveView& view);
  const View* find(std::uint32_t id) const;

  std::array<View, std::size_t{2} * ALCOVE_MAX_VIEWS> views_;
};

}  // namespace alcove::passes
