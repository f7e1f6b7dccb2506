#pragma once

#include <cstddef>
#include <cstdint>
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

// A selection of pixels: those that are not 0.
using Mask = Image<uint8_t>;

}  // namespace alcove::sample
