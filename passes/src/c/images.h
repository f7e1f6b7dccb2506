// Checks the engine's images and imports them into the graph.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "alcove/alcove.h"
#include "alcove/framegraph/graph.h"
#include "alcove/passes/frame.h"
#include "c/failure.h"

namespace alcove::passes {

// The purpose of an image, and the formats that suit it.
struct ImageRole {
  const char* name = "";
  enum class Kind : std::uint8_t { depth, colour, signed_colour, mask } kind = Kind::colour;
  std::uint32_t channels = 1;  // that the format has at least
  bool output = false;
  bool may_have_samples = false;  // more than one per pixel
};

// Converts the areas of a view. With dynamic resolution, images may be larger than the part that is
// in use.
[[nodiscard]] ImageAreas to_areas(const AlcoveView& view);

// Checks an image of a view. The passes check that the sizes of images fit together.
[[nodiscard]] tl::expected<void, Failure> check_image(const ImageRole& role,
                                                      const AlcoveImage& image,
                                                      const AlcoveView& view);

// The images of one frame. An image that serves as several inputs becomes one texture of the graph.
class ImageTable {
 public:
  static constexpr std::size_t kImagesOfAView = 12;

  void reset() { count_ = 0; }

  // Checks and imports an image of a view. Returns a null texture if there is no image.
  [[nodiscard]] tl::expected<framegraph::Texture, Failure> import(framegraph::Graph& graph,
                                                                  const ImageRole& role,
                                                                  const AlcoveImage& image,
                                                                  const AlcoveView& view);

 private:
  struct Entry {
    AlcoveImage image;
    framegraph::Texture texture;
    bool output = false;
    std::uint32_t view = 0;  // the id of the last view that has it
  };
  std::array<Entry, ALCOVE_MAX_VIEWS * kImagesOfAView> entries_;
  std::size_t count_ = 0;
};

}  // namespace alcove::passes
