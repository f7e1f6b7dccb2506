#include <cstdio>  // jpeglib.h needs it first

#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>

#include "support/image_rows.h"
#include "support/result.h"

namespace alcove::sample {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr const char* kDamaged = "is damaged";

struct Errors {
  jpeg_error_mgr base;  // first: libjpeg hands out a pointer to it
  std::jmp_buf jump;
};

[[noreturn]] void leave(j_common_ptr jpeg) {
  std::longjmp(reinterpret_cast<Errors*>(jpeg->err)->jump, 1);
}

// Handles a message of libjpeg. If data is damaged, libjpeg only warns (level -1) and continues
// with grey. Here a warning is an error, except for warnings after which the pixels are still
// right.
void judge(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  const bool harmless = code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR ||
                        code == JWRN_BOGUS_ICC || code == JWRN_ADOBE_XFORM;
  if (level < 0 && !harmless) leave(jpeg);
}

void print_nothing(j_common_ptr /*jpeg*/) {}

// Limits the number of scans. Each scan of a progressive JPEG covers the whole image, and a file of
// a megabyte can contain 100,000 empty scans. Encoders write at most about 20.
void limit_scans(j_common_ptr jpeg) {
  constexpr int kMostScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMostScans) leave(jpeg);
}

class JpegReader {
 public:
  explicit JpegReader(Bytes bytes) : bytes_(bytes) {
    jpeg_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = leave;
    errors_.base.emit_message = judge;
    errors_.base.output_message = print_nothing;
    progress_.progress_monitor = limit_scans;
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }

  // Returns false if the header is damaged. libjpeg reports errors with longjmp, which must not
  // skip destructors. These functions therefore only have local variables of trivial types.
  bool read_header() {
    if (setjmp(errors_.jump)) return false;
    jpeg_create_decompress(&jpeg_);
    jpeg_.progress = &progress_;
    // libjpeg keeps the coefficients of progressive images, 2 bytes per sample, until the last
    // scan.
    constexpr long kMostMemory = 512L << 20;
    jpeg_.mem->max_memory_to_use = kMostMemory;
    jpeg_mem_src(&jpeg_, bytes_.data(), static_cast<unsigned long>(bytes_.size()));
    return jpeg_read_header(&jpeg_, TRUE) == JPEG_HEADER_OK;
  }

  // Starts decoding at 1/`scale` of the width and height. `scale` is 1, 2, 4 or 8.
  bool start(unsigned scale) {
    if (setjmp(errors_.jump)) return false;
    jpeg_.scale_num = 1;
    jpeg_.scale_denom = scale;
    const bool four_inks = jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
    jpeg_.out_color_space = four_inks ? JCS_CMYK : JCS_EXT_RGBA;
    return jpeg_start_decompress(&jpeg_) != FALSE;
  }

  bool read_rows(ImageRows& rows) {
    if (setjmp(errors_.jump)) return false;
    while (jpeg_.output_scanline < jpeg_.output_height) {
      const uint32_t y = jpeg_.output_scanline;
      JSAMPROW pointer = rows.row(y);
      if (jpeg_read_scanlines(&jpeg_, &pointer, 1) != 1) return false;
      if (jpeg_.out_color_space == JCS_CMYK) make_rgba(pointer);
      rows.complete(y);
    }
    return true;
  }

  // Whether the last failure was the limit on memory.
  bool lacked_memory() const {
    const int code = errors_.base.msg_code;
    return code == JERR_OUT_OF_MEMORY || code == JERR_NO_BACKING_STORE;
  }

  uint32_t width() const { return jpeg_.image_width; }
  uint32_t height() const { return jpeg_.image_height; }
  uint32_t output_width() const { return jpeg_.output_width; }
  uint32_t output_height() const { return jpeg_.output_height; }

 private:
  // In Adobe's CMYK files the inks are stored inverted: 255 is no ink.
  void make_rgba(uint8_t* pixel) const {
    for (uint32_t x = 0; x < jpeg_.output_width; ++x, pixel += 4) {
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<uint8_t>(pixel[c] * pixel[3] / 255);
      pixel[3] = 0xff;
    }
  }

  Bytes bytes_;
  jpeg_decompress_struct jpeg_{};
  Errors errors_{};
  jpeg_progress_mgr progress_{};
};

Failure decoding_failure(const JpegReader& reader) {
  return Failure(reader.lacked_memory()
                     ? "is a progressive JPEG that needs over 512 MiB to decode (save it as a "
                       "baseline JPEG)"
                     : kDamaged);
}

// Returns the part of the reduction that libjpeg can do: the largest power of 2 up to 8 that
// divides it.
unsigned libjpeg_scale(uint32_t reduction) {
  unsigned scale = 1;
  while (scale < 8 && reduction % (2 * scale) == 0) scale *= 2;
  return scale;
}

}  // namespace

bool is_jpeg(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

Result<ImageHeader> read_jpeg_header(Bytes bytes) {
  JpegReader reader(bytes);
  if (!reader.read_header()) return Failure(kDamaged);
  // The most pixels that one byte can encode: a Huffman code has at least one bit, and a block of
  // 64 pixels has at least one code. Interleaved sampling and arithmetic coding can save a little
  // more.
  constexpr uint64_t kMostPixelsPerByte = 2048;
  if (uint64_t{reader.width()} * reader.height() / kMostPixelsPerByte > bytes.size())
    return Failure("is cut short");
  return ImageHeader{ImageFormat::jpeg, reader.width(), reader.height()};
}

Result<DecodedImage> decode_jpeg(Bytes bytes, uint32_t reduction) {
  JpegReader reader(bytes);
  const unsigned scale = libjpeg_scale(reduction);
  if (!reader.read_header() || !reader.start(scale)) return decoding_failure(reader);
  ImageRows rows(reader.output_width(), reader.output_height(), reduction / scale, false);
  if (!reader.read_rows(rows)) return decoding_failure(reader);
  return rows.take();
}

}  // namespace alcove::sample
