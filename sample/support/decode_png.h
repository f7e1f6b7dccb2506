#pragma once

#include "support/decode_image.h"

namespace alcove::sample {

// The functions of decode_image.h for PNG.
[[nodiscard]] bool is_png(std::span<const uint8_t> bytes);
[[nodiscard]] tl::expected<ImageHeader, std::string> read_png_header(
    std::span<const uint8_t> bytes);
[[nodiscard]] tl::expected<DecodedImage, std::string> decode_png(std::span<const uint8_t> bytes,
                                                                 uint32_t reduction);

}  // namespace alcove::sample
