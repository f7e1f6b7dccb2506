#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace alcove::sample {

// The upper one of the two in the middle where there are two; 0 of nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace alcove::sample
