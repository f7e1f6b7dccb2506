#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "support/decode_image.h"

namespace alcove::sample {

// Decodes an image with and without reduction, as large as is quick.
inline void decode_any(std::span<const uint8_t> bytes) {
  constexpr uint64_t kMostPixels = 1 << 20;
  const auto header = read_image_header(bytes);
  if (!header || uint64_t{header->width} * header->height > kMostPixels) return;
  for (const uint32_t reduction : {1u, 3u, 8u}) {
    const auto image = decode_image(bytes, *header, reduction);
    if (!image) return;
    const uint32_t width = (header->width + reduction - 1) / reduction;
    const uint32_t height = (header->height + reduction - 1) / reduction;
    if (image->width != width || image->height != height ||
        image->rgba.size() != size_t{4} * width * height)
      __builtin_trap();
  }
}

}  // namespace alcove::sample
