#pragma once

#include <string>

#include "support/float_rows.h"
#include "support/result.h"

namespace alcove::sample {

// Reads a Radiance picture (.hdr, "-Y H +X W", 32-bit_rle_rgbe), after the description of the
// format in Ward, "Real Pixels", Graphics Gems II, and the documentation of Radiance. Alcove has
// its own reader, because the format is simple and the libraries in Debian that read it (stb_image,
// FreeImage) are not maintained against hostile files. It keeps one row in memory. The size in the
// header limits the time, and every count is checked against the row. Rows are R, G, B. Error
// texts are the end of a sentence that begins with the file's name.
[[nodiscard]] Result<void> read_hdr(std::FILE* file, const FloatRows& rows);

}  // namespace alcove::sample
