// Which resource last used which bytes of a heap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

struct Segment {
  VkDeviceSize begin = 0;
  VkDeviceSize end = 0;
  std::uint32_t resource = kNone;
  bool before = false;  // in the frame before
};

// Segments in order, none overlapping.
using MemoryMap = std::vector<Segment>;

// The first segment that ends after an offset.
inline std::size_t first_after(const MemoryMap& map, VkDeviceSize offset) {
  const Segment* first = map.data();
  for (std::size_t count = map.size(); count > 0;) {
    const std::size_t half = count / 2;
    const bool before = first[half].end <= offset;
    first = before ? first + half + 1 : first;
    count = before ? count - half - 1 : half;
  }
  return static_cast<std::size_t>(first - map.data());
}

// Calls f for each owner of bytes in [begin, end), then makes them `owner`'s.
template <typename Function>
void take_over(MemoryMap& map, const Segment& owner, Function&& f) {
  const std::size_t first = first_after(map, owner.begin);
  std::size_t last = first;
  for (; last < map.size() && map[last].begin < owner.end; ++last) f(map[last]);
  // As a rule one owner's bytes go to another whole.
  if (last == first + 1 && map[first].begin >= owner.begin && map[first].end <= owner.end) {
    map[first] = owner;
    return;
  }
  // What is left of the first and the last of those on either side.
  Segment kept[3];
  std::size_t keep = 0;
  if (last > first && map[first].begin < owner.begin) {
    kept[keep] = map[first];
    kept[keep++].end = owner.begin;
  }
  kept[keep++] = owner;
  if (last > first && map[last - 1].end > owner.end) {
    kept[keep] = map[last - 1];
    kept[keep++].begin = owner.end;
  }
  const std::size_t old = last - first;
  if (keep > old) {
    map.insert(map.begin() + static_cast<std::ptrdiff_t>(last), keep - old, Segment{});
  } else {
    map.erase(map.begin() + static_cast<std::ptrdiff_t>(first + keep),
              map.begin() + static_cast<std::ptrdiff_t>(last));
  }
  for (std::size_t i = 0; i < keep; ++i) map[first + i] = kept[i];
}

// Gives those bytes of [begin, end) to `owner` that nobody has; how many they were.
inline VkDeviceSize claim_free(MemoryMap& map, const Segment& owner) {
  VkDeviceSize claimed = 0;
  VkDeviceSize at = owner.begin;
  for (std::size_t i = first_after(map, at); at < owner.end; ++i) {
    if (i < map.size() && map[i].begin <= at) {
      at = std::max(at, map[i].end);
      continue;
    }
    Segment gap = owner;
    gap.begin = at;
    if (i < map.size()) gap.end = std::min(owner.end, map[i].begin);
    map.insert(map.begin() + static_cast<std::ptrdiff_t>(i), gap);
    claimed += gap.end - gap.begin;
    at = gap.end;
  }
  return claimed;
}

}  // namespace alcove::framegraph
