#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "support/float_rows.h"
#include "support/regular_file.h"

namespace alcove::sample {

// Reads an image with `read(file, rows)`. Checks that no row is missing, has another length or
// comes after the last one.
template <class Read>
void read_any(const uint8_t* data, size_t size, size_t channels, const Read& read) {
  if (size == 0) return;
  const FilePointer file(fmemopen(const_cast<uint8_t*>(data), size, "rb"));
  if (!file) return;
  uint32_t width = 0, left = 0;
  const FloatRows rows{.begin =
                           [&](uint32_t columns, uint32_t height) {
                             width = columns;
                             left = height;
                           },
                       .row =
                           [&](std::span<const float> row) {
                             if (left-- == 0 || row.size() != channels * width) __builtin_trap();
                           }};
  const auto done = read(file.get(), rows);
  if (done ? left != 0 : done.error().empty()) __builtin_trap();
}

}  // namespace alcove::sample
