#pragma once

#include "support/decode_image.h"

namespace alcove::sample {

// The functions of decode_image.h for JPEG.
[[nodiscard]] bool is_jpeg(std::span<const uint8_t> bytes);
[[nodiscard]] tl::expected<ImageHeader, std::string> read_jpeg_header(
    std::span<const uint8_t> bytes);
[[nodiscard]] tl::expected<DecodedImage, std::string> decode_jpeg(std::span<const uint8_t> bytes,
                                                                  uint32_t reduction);

}  // namespace alcove::sample
