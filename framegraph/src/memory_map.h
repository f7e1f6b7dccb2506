// For each byte of a heap, the resource that used it last.
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
  bool before = false;  // it used them in the previous frame
};

// Segments in ascending order that do not overlap.
using MemoryMap = std::vector<Segment>;

// Returns the first segment that ends after an offset.
inline Segment* first_after(MemoryMap& map, VkDeviceSize offset) {
  Segment* first = map.data();
  for (std::size_t count = map.size(); count > 0;) {
    const std::size_t half = count / 2;
    const bool before = first[half].end <= offset;
    first = before ? first + half + 1 : first;
    count = before ? count - half - 1 : half;
  }
  return first;
}

// Calls f for each segment that overlaps [owner.begin, owner.end), then gives these bytes to
// `owner`.
template <typename Function>
inline void take_over(MemoryMap& map, const Segment& owner, Function&& f) {
  Segment* const first = first_after(map, owner.begin);
  Segment* const end = map.data() + map.size();
  Segment* last = first;
  for (; last != end && last->begin < owner.end; ++last) f(*last);
  // The common case: `owner` takes the bytes of one segment exactly.
  if (last == first + 1 && first->begin >= owner.begin && first->end <= owner.end) {
    *first = owner;
    return;
  }
  // The parts of the first and the last owner that remain on either side.
  Segment kept[3];
  std::ptrdiff_t keep = 0;
  if (last != first && first->begin < owner.begin) {
    kept[keep] = *first;
    kept[keep++].end = owner.begin;
  }
  kept[keep++] = owner;
  if (last != first && last[-1].end > owner.end) {
    kept[keep] = last[-1];
    kept[keep++].begin = owner.end;
  }
  const std::ptrdiff_t old = last - first;
  const auto from = map.begin() + (first - map.data());
  if (keep > old)
    std::copy(kept, kept + keep, map.insert(from, static_cast<std::size_t>(keep - old), Segment{}));
  else
    map.erase(std::copy(kept, kept + keep, from), from + old);
}

// Gives those bytes of [owner.begin, owner.end) that no resource owns to `owner`, and returns their
// number.
inline VkDeviceSize claim_free(MemoryMap& map, const Segment& owner) {
  VkDeviceSize claimed = 0;
  VkDeviceSize at = owner.begin;
  for (auto i = static_cast<std::size_t>(first_after(map, at) - map.data()); at < owner.end; ++i) {
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
