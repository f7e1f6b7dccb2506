// Converts a view of the C interface, and adds its passes.
#pragma once

#include "alcove/alcove.h"
#include "alcove/passes/frame.h"
#include "c/failure.h"
#include "c/images.h"
#include "work/view_work.h"

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

// Returns the beginning of a sentence about the view, such as "View 3".
[[nodiscard]] std::string view_name(const AlcoveView& view);

// Copies the matrices. The passes check them.
[[nodiscard]] View to_view(const AlcoveCamera& camera);

// Makes a texture of an image of a view, or a null texture if there is no image.
struct ImageImporter {
  tl::expected<framegraph::Texture, Failure> (*import)(void* user, const ImageRole& role,
                                                       const AlcoveImage& image,
                                                       const AlcoveView& view);
  void* user;
};

// The inputs of a view, and its settings with the outputs that it has images for.
struct ViewSetup {
  ViewInputs inputs;
  OcclusionSettings settings;
};

// Checks a view and imports its images.
[[nodiscard]] tl::expected<ViewSetup, Failure> set_up(const AlcoveView& view,
                                                      const ImageImporter& importer);

class PixelObserver;

// Adds the passes of `view` to the graph. `prepare` is stored in Frame::prepare. If `observer` is
// not null, it adds a pass that samples the view's pixels for the frame slot AlcoveFrame::slot.
[[nodiscard]] tl::expected<void, Failure> add_view(framegraph::Graph& graph, Kernels& kernels,
                                                   ImageTable& images, const AlcoveView& view,
                                                   const AlcoveFrame& frame, bool prepare,
                                                   PixelObserver* observer);

}  // namespace alcove::passes
