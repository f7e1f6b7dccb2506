#pragma once

#include <utility>

#include "support/block_mean.h"
#include "support/decode_image.h"
#include "support/result.h"

namespace alcove::sample {

// Receives the rows of an image that is being decoded to RGBA, and reduces it.
class ImageRows {
 public:
  // If `keeps_all` is true, the memory of a row stays as the decoder left it until the row is
  // complete, as an interlaced image needs.
  ImageRows(uint32_t width, uint32_t height, uint32_t reduction, bool keeps_all)
      : reduces_(reduction > 1),
        row_bytes_(4 * size_t{width}),
        stride_(reduces_ && !keeps_all ? 0 : row_bytes_),
        mean_(width, height, reduction),
        out_{mean_.reduced(width), mean_.reduced(height), {}} {
    out_.rgba.resize(4 * size_t{out_.width} * out_.height);
    if (reduces_) rows_.resize(stride_ == 0 ? row_bytes_ : row_bytes_ * height);
  }

  // Returns the memory of a row.
  uint8_t* row(uint32_t y) { return (reduces_ ? rows_ : out_.rgba).data() + y * stride_; }
  // Takes a complete row. The rows come from the top to the bottom.
  void complete(uint32_t y) {
    if (!reduces_) return;
    mean_.add_row({row(y), row_bytes_}, [this](size_t, uint32_t value) {
      out_.rgba[written_++] = static_cast<uint8_t>(value);
    });
  }
  DecodedImage take() { return std::move(out_); }

 private:
  bool reduces_;
  size_t row_bytes_, stride_;
  BlockMean<uint8_t, uint32_t, 4> mean_;
  DecodedImage out_;
  std::vector<uint8_t> rows_;  // before the reduction; one row if stride_ is 0
  size_t written_ = 0;
};

// The functions of decode_image.h for PNG and for JPEG.
[[nodiscard]] bool is_png(std::span<const uint8_t> bytes);
[[nodiscard]] Result<ImageHeader> read_png_header(std::span<const uint8_t> bytes);
[[nodiscard]] Result<DecodedImage> decode_png(std::span<const uint8_t> bytes, uint32_t reduction);
[[nodiscard]] bool is_jpeg(std::span<const uint8_t> bytes);
[[nodiscard]] Result<ImageHeader> read_jpeg_header(std::span<const uint8_t> bytes);
[[nodiscard]] Result<DecodedImage> decode_jpeg(std::span<const uint8_t> bytes, uint32_t reduction);

}  // namespace alcove::sample
