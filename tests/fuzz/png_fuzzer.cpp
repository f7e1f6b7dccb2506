// Fuzzes the reading of PNG files with libFuzzer. The checksums of the chunks are corrected first:
// mutated bytes nearly never have the right checksum, and libpng would refuse them at once.
#include <zlib.h>

#include <vector>

#include "decode_any.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t kSignature = 8, kChunk = 12;  // bytes; a chunk is length, type, data, checksum
  std::vector<uint8_t> png(data, data + size);
  for (size_t at = kSignature; at < png.size() && png.size() - at >= kChunk;) {
    const size_t length = size_t{png[at]} << 24 | size_t{png[at + 1]} << 16 |
                          size_t{png[at + 2]} << 8 | size_t{png[at + 3]};
    if (length > png.size() - at - kChunk) break;
    const auto sum = crc32(0, png.data() + at + 4, static_cast<uInt>(length + 4));
    for (size_t i = 0; i < 4; ++i)
      png[at + 8 + length + i] = static_cast<uint8_t>(sum >> (24 - 8 * i));
    at += kChunk + length;
  }
  alcove::sample::decode_any(png);
  return 0;
}
