#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace alcove::sample {

// Sets of the numbers below a count, which begin apart and grow together (union-find).
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  // Returns the number that stands for the set of a number.
  uint32_t root(uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parents_[root(a)] = root(b); }

 private:
  std::vector<uint32_t> parents_;
};

}  // namespace alcove::sample
