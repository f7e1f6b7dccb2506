#pragma once

#include <filesystem>

#include "support/glm.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Writers of image files. A file is written completely or not at all (whole_file.h).
// Errors are one sentence with the file's name and the reason.

// OpenEXR, scanlines, 32-bit float, top row first: one channel `Y`, or three `R` `G` `B`.
[[nodiscard]] Result<void> write_exr(const std::filesystem::path& file, const Image<float>& image);
[[nodiscard]] Result<void> write_exr(const std::filesystem::path& file,
                                     const Image<glm::vec3>& image);

// Writes an 8-bit PNG. Values are clamped to 0..1 and stored without a transfer function; callers
// encode sRGB themselves. NaN becomes 0.
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const Image<float>& image);
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file,
                                     const Image<glm::vec3>& image);

}  // namespace alcove::sample
