// Imports the images of a view, and adds its passes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "alcove/alcove.h"
#include "alcove/passes/graph.h"
#include "c/failure.h"

namespace alcove::passes {

// The images of one frame. An image that serves as several inputs becomes one texture of the graph.
class ImageTable {
 public:
  void reset() { count_ = part_count_ = 0; }

  // Checks and imports an image of a view. Returns a null texture if there is no image.
  [[nodiscard]] tl::expected<framegraph::Texture, Error> import(framegraph::Graph& graph,
                                                                const AlcoveView& view,
                                                                std::uint32_t role);

 private:
  struct Entry {
    AlcoveImage image;
    framegraph::Texture texture;
    bool output = false;
  };
  // The pixels of an output that a view writes.
  struct Part {
    const Entry* entry;
    AlcoveArea area;
    std::uint32_t view;  // its id
  };
  std::array<Entry, std::size_t{ALCOVE_MAX_VIEWS} * ALCOVE_IMAGE_COUNT> entries_;
  std::array<Part, std::size_t{ALCOVE_MAX_VIEWS} * (ALCOVE_IMAGE_COUNT - ALCOVE_IMAGE_FIRST_OUTPUT)>
      parts_;
  std::size_t count_ = 0;
  std::size_t part_count_ = 0;
};

class PixelObserver;

// Adds the passes of `view` to the graph, or with `prepare` only creates their pipelines. If
// `observer` is not null, it adds a pass that samples the view's pixels for the frame slot
// AlcoveFrame::slot.
[[nodiscard]] Result add_view(framegraph::Graph& graph, Pipelines& pipelines, ImageTable& images,
                              const AlcoveView& view, const AlcoveFrame& frame, bool prepare,
                              PixelObserver* observer);

}  // namespace alcove::passes
