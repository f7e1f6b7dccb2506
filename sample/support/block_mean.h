#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove::sample {

// Reduces an image while it is read row by row: each block of `factor` x `factor` pixels becomes
// its mean. At the right and lower edge, it is the mean of the pixels that exist. A pixel has
// `kComponents` interleaved components of type `In`, which are summed as `Sum`.
template <class In, class Sum, uint32_t kComponents>
class BlockMean {
 public:
  // All arguments are at least 1.
  BlockMean(uint32_t width, uint32_t height, uint32_t factor)
      : width_(width), factor_(factor), rows_left_(height) {
    sums_.resize(size_t{reduced(width)} * kComponents);
  }

  [[nodiscard]] uint32_t reduced(uint32_t side) const { return (side + factor_ - 1) / factor_; }

  // Adds the next row from the top. `write(i, mean)` is called for each component of a finished
  // row, in order.
  template <class Write>
  void add_row(std::span<const In> row, const Write& write) {
    for (uint32_t x = 0; x < width_; ++x) {
      for (uint32_t c = 0; c < kComponents; ++c) {
        sums_[size_t{x / factor_} * kComponents + c] +=
            static_cast<Sum>(row[size_t{x} * kComponents + c]);
      }
    }
    --rows_left_;
    if (++rows_ < factor_ && rows_left_ > 0) return;
    for (size_t i = 0; i < sums_.size(); ++i) {
      const auto first = static_cast<uint32_t>(i / kComponents) * factor_;
      const uint32_t columns = std::min(factor_, width_ - first);
      const size_t pixels = std::max(size_t{columns} * rows_, size_t{1});
      write(i, sums_[i] / static_cast<Sum>(pixels));
    }
    std::fill(sums_.begin(), sums_.end(), Sum{});
    rows_ = 0;
  }

 private:
  uint32_t width_;
  uint32_t factor_;
  uint32_t rows_left_;
  uint32_t rows_ = 0;  // rows of the current block so far
  std::vector<Sum> sums_;
};

}  // namespace alcove::sample
