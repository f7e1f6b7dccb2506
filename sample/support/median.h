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

// Half the distance between the first and the third quartile: how far apart values are, whatever a
// few of them are. 0 of nothing.
inline double quartile_spread(std::vector<double> values) {
  if (values.empty()) {
    return 0;
  }
  std::ranges::sort(values);
  const std::size_t last = values.size() - 1;
  return 0.5 * (values[3 * last / 4] - values[last / 4]);
}

}  // namespace alcove::sample
