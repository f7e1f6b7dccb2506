// The engine's images in the C interface: what they have to be, and their place in the graph.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "alcove/alcove.h"
#include "alcove/framegraph/graph.h"
#include "c_failure.h"

namespace alcove::passes {

// What an image is for, and what its format has to be for that.
struct ImageRole {
  const char* name = "";
  enum class Kind : std::uint8_t { depth, colour, signed_colour } kind = Kind::colour;
  std::uint32_t channels = 1;  // at least
  bool output = false;
};

// The images of one frame. One that serves as several inputs is one texture of the graph.
class ImageTable {
 public:
  static constexpr std::size_t kImagesOfAView = 11;

  void reset() { count_ = 0; }

  // The image of view `view` as a texture of `graph`, null where there is none. Its size must be
  // that of `depth`.
  [[nodiscard]] tl::expected<framegraph::Texture, Failure> import(framegraph::Graph& graph,
                                                                  const ImageRole& role,
                                                                  const AlcoveImage& image,
                                                                  const AlcoveImage& depth,
                                                                  std::uint32_t view);

 private:
  struct Entry {
    AlcoveImage image;
    framegraph::Texture texture;
    bool output = false;
  };
  std::array<Entry, ALCOVE_MAX_VIEWS * kImagesOfAView> entries_;
  std::size_t count_ = 0;
};

}  // namespace alcove::passes
