// Checks the engine's images and imports them into the graph.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "alcove/alcove.h"
#include "alcove/framegraph/graph.h"
#include "c/failure.h"

namespace alcove::passes {

// The purpose of an image, and the formats that suit it.
struct ImageRole {
  const char* name = "";
  enum class Kind : std::uint8_t { depth, colour, signed_colour } kind = Kind::colour;
  std::uint32_t channels = 1;  // that the format has at least
  bool output = false;
  bool keeps_channels = false;  // one channel of the output is written, the others are kept
  bool half_size = false;       // it has half of depth's size, rounded up
};

// Checks an image of the view with the id `view`. Its size must be that of `depth`, or with
// ImageRole::half_size half of it.
[[nodiscard]] tl::expected<void, Failure> check_image(const ImageRole& role,
                                                      const AlcoveImage& image,
                                                      const AlcoveImage& depth, std::uint32_t view);

// The images of one frame. An image that serves as several inputs becomes one texture of the graph.
class ImageTable {
 public:
  static constexpr std::size_t kImagesOfAView = 11;

  void reset() { count_ = 0; }

  // Checks and imports an image of the view with the id `view`. Returns a null texture if there is
  // no image.
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
