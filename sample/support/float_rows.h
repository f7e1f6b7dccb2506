#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

// Takes an image of 32-bit floats row by row, so that a reader never holds all of it.
struct FloatRows {
  // Called once, before the first row, with a size of at least 1 and at most kLargestFloatSide.
  std::function<void(uint32_t width, uint32_t height)> begin;
  // Called for each row, the top one first: the channels of its pixels, interleaved.
  std::function<void(std::span<const float> row)> row;
};

// Pixels. The largest side that the readers of float images take.
constexpr uint32_t kLargestFloatSide = 16384;

}  // namespace alcove::sample
