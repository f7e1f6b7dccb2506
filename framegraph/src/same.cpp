// Compares and hashes declarations as bytes, which is correct because the records have no padding.
#include <cstring>

#include "alcove/framegraph/description.h"

namespace alcove::framegraph {
namespace {

template <typename Record>
bool same(const Records<Record>& a, const Records<Record>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0);
}

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  a = (a ^ b) * 0x9fb21c651e98df25u;
  return a ^ (a >> 32);
}

// Hashes eight bytes at a time in four independent lanes. The sizes of the records are multiples of
// four bytes.
template <typename Record>
std::uint64_t hash_records(std::uint64_t seed, const Records<Record>& records) {
  static_assert(sizeof(Record) % 4 == 0);
  const auto* bytes = reinterpret_cast<const unsigned char*>(records.data());
  std::size_t size = records.size() * sizeof(Record);
  std::uint64_t lanes[4] = {mix(seed, size), seed + 1, seed + 2, seed + 3};
  for (; size >= 32; size -= 32, bytes += 32) {
    std::uint64_t words[4];
    std::memcpy(words, bytes, 32);
    for (int i = 0; i < 4; ++i) lanes[i] = mix(lanes[i], words[i]);
  }
  std::uint64_t words[4] = {};
  if (size != 0) std::memcpy(words, bytes, size);
  for (int i = 0; i < 4; ++i) lanes[i] = mix(lanes[i], words[i]);
  return mix(mix(lanes[0], lanes[1]), mix(lanes[2], lanes[3]));
}

}  // namespace

bool same_declaration(const GraphDescription& a, const GraphDescription& b) {
  if (a.accesses.size() != b.accesses.size() || a.resources.size() != b.resources.size() ||
      a.externals.size() != b.externals.size() || a.outputs.size() != b.outputs.size())
    return false;
  // Descriptions with the same edition have the same records, except for pass records: their flags
  // may be set after the pass was added. Pass records are therefore always compared.
  if (!same(a.passes, b.passes)) return false;
  return a.edition == b.edition ||
         (same(a.accesses, b.accesses) && same(a.resources, b.resources) &&
          same(a.externals, b.externals) && same(a.outputs, b.outputs));
}

std::uint64_t hash(const GraphDescription& description) {
  std::uint64_t value = hash_records(1, description.passes);
  value = hash_records(value, description.accesses);
  value = hash_records(value, description.resources);
  value = hash_records(value, description.externals);
  return hash_records(value, description.outputs);
}

}  // namespace alcove::framegraph
