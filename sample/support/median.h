#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace alcove::sample {

// Returns the median. If the number of values is even, it is the larger of the two in the middle. 0
// if there are no values.
template <class T>
[[nodiscard]] T median(std::vector<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Returns the element of the sorted values at the fraction `share`, [0,1], of their number, rounded
// down. 0 if there are no values.
template <class T>
[[nodiscard]] T percentile(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + rank);
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace alcove::sample
