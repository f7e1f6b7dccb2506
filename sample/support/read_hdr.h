#pragma once

#include "support/float_rows.h"

namespace alcove::sample {

// Reads a Radiance picture (.hdr, "-Y H +X W", 32-bit_rle_rgbe), after the format's description in
// Ward, "Real Pixels", Graphics Gems II, and the file formats of Radiance. The reader is our own:
// the format is two loops long, and the libraries in Debian that read it (stb_image, FreeImage) are
// not maintained against hostile files. Memory is one row; the time is bounded by the size in the
// header, and every count by the row. Rows are R, G, B. Errors are the end of a sentence that
// begins with the file's name.
[[nodiscard]] tl::expected<void, std::string> read_hdr(std::FILE* file, const FloatRows& rows);

}  // namespace alcove::sample
