#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/result.h"

namespace alcove::sample {

// Decodes PNG (with libpng) and JPEG (with libjpeg-turbo), the two image formats of glTF. The bytes
// may be hostile: both libraries are maintained for such input and fuzzed with it. The signature
// determines the format, and the header is checked against limits on time and memory before
// anything is decoded. Error texts are the end of a sentence that begins with the image's name.
// Thread-safe.

enum class ImageFormat : uint8_t { png, jpeg };

struct ImageHeader {
  ImageFormat format = ImageFormat::png;
  uint32_t width = 0;   // pixels, at least 1
  uint32_t height = 0;  // pixels, at least 1
};

// Texels after decoding: 8-bit RGBA as stored in the file (no gamma or colour profile is applied,
// as glTF asks), top row first, 4 * width * height bytes.
struct DecodedImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<uint8_t> rgba;
};

// The largest side, in pixels, that a caller should decode: the largest texture of most devices.
constexpr uint32_t kLargestImageSide = 16384;

// Reads the size from the header without decoding. Another format, a damaged header, or a file too
// short for so many pixels is an error, and so is a PNG of more than 2^26 pixels that is interlaced
// or has less than one byte for 64 pixels.
[[nodiscard]] Result<ImageHeader> read_image_header(std::span<const uint8_t> bytes);

// Decodes an image. `header` is the result of read_image_header() for the same bytes. Every block
// of `reduction` x `reduction` pixels (at least 1) becomes its mean, and the full image is then not
// kept in memory, except for an interlaced PNG. Data that is damaged or cut short, and a
// progressive JPEG that needs more than 512 MiB, are errors.
[[nodiscard]] Result<DecodedImage> decode_image(std::span<const uint8_t> bytes,
                                                const ImageHeader& header, uint32_t reduction = 1);

}  // namespace alcove::sample
