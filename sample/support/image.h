#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace alcove::sample {

// A plain image: row-major, top row first, rows tightly packed.
template <class T>
struct Image {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(uint32_t width_, uint32_t height_, T value = T{})
      : width(width_), height(height_), pixels(size_t{width_} * height_, value) {}

  // `x` < width, `y` < height, y downwards.
  T& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
  const T& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
  bool empty() const { return pixels.empty(); }
};

// Returns the image of the values of a function of the pixels of one image or of several images of
// the same size.
template <class Function, class First, class... Rest>
auto mapped(const Function& function, const Image<First>& first, const Image<Rest>&... rest) {
  Image<std::decay_t<std::invoke_result_t<Function, First, Rest...>>> result(first.width,
                                                                             first.height);
  for (size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = function(first.pixels[i], rest.pixels[i]...);
  return result;
}

// A selection of pixels: those that are not 0.
using Mask = Image<uint8_t>;

}  // namespace alcove::sample
