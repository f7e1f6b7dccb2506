#include "support/decode_image.h"

#include "support/foreign_file.h"
#include "support/image_rows.h"

namespace alcove::sample {

Result<ImageHeader> read_image_header(std::span<const uint8_t> bytes) {
  if (is_png(bytes)) return read_png_header(bytes);
  if (is_jpeg(bytes)) return read_jpeg_header(bytes);
  const std::string kind = foreign_kind(bytes, "glTF has no other image formats");
  return Failure(kind.empty() ? "is not a PNG or JPEG (glTF has no other image formats)"
                              : "is not a PNG or JPEG: it " + kind);
}

Result<DecodedImage> decode_image(std::span<const uint8_t> bytes, const ImageHeader& header,
                                  uint32_t reduction) {
  return header.format == ImageFormat::png ? decode_png(bytes, reduction)
                                           : decode_jpeg(bytes, reduction);
}

}  // namespace alcove::sample
