// Declares the passes of one view of the C interface.
#pragma once

#include "alcove/alcove.h"
#include "alcove/passes/frame.h"
#include "c/failure.h"
#include "c/images.h"

namespace alcove::passes {

// The name of a view's history. The text is stored in the object, because a frame that repeats the
// previous one must not allocate memory.
class ViewName {
 public:
  explicit ViewName(std::uint32_t id);
  operator std::string_view() const { return text_.data(); }

 private:
  std::array<char, 16> text_{};  // "view 4294967295"
};

class PixelObserver;

// Adds the passes of `view` to the graph. `prepare` is stored in Frame::prepare. If `observer` is
// not null, it adds a pass that samples the view's pixels for the frame slot AlcoveFrame::slot.
[[nodiscard]] tl::expected<void, Failure> add_view(framegraph::Graph& graph, Kernels& kernels,
                                                   ImageTable& images, const AlcoveView& view,
                                                   const AlcoveFrame& frame, bool prepare,
                                                   PixelObserver* observer);

}  // namespace alcove::passes
