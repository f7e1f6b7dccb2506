#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

// Receives an image of 32-bit floats row by row, so that its reader never holds the whole image.
struct FloatRows {
  // Called once, before the first row, with a size of at least 1 and at most kLargestFloatSide.
  std::function<void(uint32_t width, uint32_t height)> begin;
  // Called for each row, the top one first: the channels of its pixels, interleaved.
  std::function<void(std::span<const float> row)> row;
};

// The largest width and height in pixels that the readers of float images accept.
constexpr uint32_t kLargestFloatSide = 16384;

}  // namespace alcove::sample
