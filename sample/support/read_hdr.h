#pragma once

#include "support/float_rows.h"

namespace alcove::sample {

// Reads a Radiance picture (.hdr, "-Y H +X W", 32-bit_rle_rgbe), after the format's description in
// Ward, "Real Pixels", Graphics Gems II, and the file formats of Radiance. The reader is part of
// Alcove, because the format is simple and the libraries in Debian that read it (stb_image,
// FreeImage) are not maintained against hostile files. It holds one row in memory. The size in the
// header bounds the time, and the row bounds every count. Rows are R, G, B. Errors are the end of a
// sentence that begins with the file's name.
[[nodiscard]] tl::expected<void, std::string> read_hdr(std::FILE* file, const FloatRows& rows);

}  // namespace alcove::sample
