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

template <typename Record>
std::uint64_t hash_records(std::uint64_t value, const Records<Record>& records) {
  static_assert(sizeof(Record) % 4 == 0);
  const auto* bytes = reinterpret_cast<const unsigned char*>(records.data());
  value ^= records.size();
  for (std::size_t left = records.size() * sizeof(Record); left != 0;) {
    const std::size_t step = left < 8 ? left : 8;
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, step);
    value = (value ^ word) * 0x9fb21c651e98df25u;
    value ^= value >> 32;
    bytes += step;
    left -= step;
  }
  return value;
}

}  // namespace

bool same_declaration(const GraphDescription& a, const GraphDescription& b) {
  if (a.accesses.size() != b.accesses.size() || a.resources.size() != b.resources.size() ||
      a.externals.size() != b.externals.size() || a.outputs.size() != b.outputs.size())
    return false;
  // The flags of pass records may be set after the pass was added, so that the edition does not
  // cover them.
  return same(a.passes, b.passes) &&
         (a.edition == b.edition ||
          (same(a.accesses, b.accesses) && same(a.resources, b.resources) &&
           same(a.externals, b.externals) && same(a.outputs, b.outputs)));
}

std::uint64_t hash(const GraphDescription& description) {
  std::uint64_t value = hash_records(1, description.passes);
  value = hash_records(value, description.accesses);
  value = hash_records(value, description.resources);
  value = hash_records(value, description.externals);
  return hash_records(value, description.outputs);
}

}  // namespace alcove::framegraph
