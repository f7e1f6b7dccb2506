#include <png.h>

#include <csetjmp>
#include <cstring>

#include "support/image_rows.h"
#include "support/result.h"

namespace alcove::sample {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr const char* kDamaged = "is damaged";

void take_bytes(png_structp png, png_bytep out, size_t size) {
  auto& left = *static_cast<Bytes*>(png_get_io_ptr(png));
  if (size > left.size()) png_error(png, "cut short");
  std::memcpy(out, left.data(), size);
  left = left.subspan(size);
}

// libpng's default functions print to stderr.
[[noreturn]] void leave(png_structp png, png_const_charp /*message*/) { png_longjmp(png, 1); }
void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

// A PNG reader for bytes in memory. It skips chunks that do not change the pixels: glTF ignores
// colour spaces, and compressed texts and profiles would only take time and memory.
class PngReader {
 public:
  explicit PngReader(Bytes bytes) : left_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, ignore);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Returns false if the header is damaged. libpng reports errors with longjmp, which must not skip
  // destructors. These functions therefore only have local variables of trivial types.
  bool read_header() {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, &left_, take_bytes);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // callers have their own
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png_, info_);
    return true;
  }

  bool read_rows(ImageRows& rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_expand(png_);    // palettes, fewer than 8 bits, transparent colours
    png_set_scale_16(png_);  // to 8 bits
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    for (int pass = 0; pass < passes; ++pass) {
      for (uint32_t y = 0; y < height(); ++y) {
        png_read_row(png_, rows.row(y), nullptr);
        if (pass == passes - 1) rows.complete(y);
      }
    }
    return true;
  }

  uint32_t width() const { return png_get_image_width(png_, info_); }
  uint32_t height() const { return png_get_image_height(png_, info_); }
  bool interlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
  uint64_t bits_per_pixel() const {
    return uint64_t{png_get_channels(png_, info_)} * png_get_bit_depth(png_, info_);
  }

 private:
  Bytes left_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

bool is_png(Bytes bytes) { return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0; }

Result<ImageHeader> read_png_header(Bytes bytes) {
  PngReader reader(bytes);
  if (!reader.read_header()) return Failure(kDamaged);
  // Deflate compresses at most 1032 bytes into one (RFC 1951: 258 bytes into 2 bits).
  constexpr uint64_t kBestRatio = 1032;
  const uint64_t row = 1 + (uint64_t{reader.width()} * reader.bits_per_pixel() + 7) / 8;
  if (row * reader.height() / kBestRatio > bytes.size()) return Failure("is cut short");
  // Larger images take seconds to decode, and interlaced ones a gibibyte of memory. Those with real
  // contents have more bytes.
  constexpr uint64_t kManyPixels = uint64_t{1} << 26, kMostPixelsPerByte = 64;
  const uint64_t pixels = uint64_t{reader.width()} * reader.height();
  if (pixels > kManyPixels && (reader.interlaced() || pixels / kMostPixelsPerByte > bytes.size())) {
    return Failure("has " + std::to_string(pixels >> 20) +
                   " million pixels, which is more than the " + std::to_string(kManyPixels >> 20) +
                   " million of " + (reader.interlaced() ? "an interlaced PNG" : "so small a PNG") +
                   " that are decoded,");
  }
  return ImageHeader{ImageFormat::png, reader.width(), reader.height()};
}

Result<DecodedImage> decode_png(Bytes bytes, uint32_t reduction) {
  PngReader reader(bytes);
  if (!reader.read_header()) return Failure(kDamaged);
  // Rows of an interlaced image are complete only at its end.
  ImageRows rows(reader.width(), reader.height(), reduction, reader.interlaced());
  if (!reader.read_rows(rows)) return Failure(kDamaged);
  return rows.take();
}

}  // namespace alcove::sample
