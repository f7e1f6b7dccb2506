#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// Files appear whole or not at all: each is written under a temporary name in its folder and then
// renamed; what an interrupted write left of a file goes with the next one, from an hour later on.
// Errors are one sentence with the file's name and the system's reason (a full disk, a
// folder that cannot be written).

// With those above it, or nothing where it is there. An error too where no file can be made in it:
// before the work, not after.
[[nodiscard]] tl::expected<void, std::string> create_folder(const std::filesystem::path& folder);

// OpenEXR, scanlines, 32-bit float, top row first: one channel `Y`, or three `R` `G` `B`.
[[nodiscard]] tl::expected<void, std::string> write_exr(const std::filesystem::path& file,
                                                        const Image<float>& image);
[[nodiscard]] tl::expected<void, std::string> write_exr(const std::filesystem::path& file,
                                                        const Image<glm::vec3>& image);

// The channel `Y`, or `R` where there is no `Y`.
[[nodiscard]] tl::expected<Image<float>, std::string> read_exr_grey(
    const std::filesystem::path& file);
// The channels `R`, `G`, `B`.
[[nodiscard]] tl::expected<Image<glm::vec3>, std::string> read_exr_rgb(
    const std::filesystem::path& file);

// 8-bit PNG. Values are clamped to 0..1 and stored as they are (encode sRGB before, if wanted);
// not-a-number becomes 0.
[[nodiscard]] tl::expected<void, std::string> write_png(const std::filesystem::path& file,
                                                        const Image<float>& image);
[[nodiscard]] tl::expected<void, std::string> write_png(const std::filesystem::path& file,
                                                        const Image<glm::vec3>& image);

// Any other file by the same rule: `write` fills the temporary file and says whether all went well.
[[nodiscard]] tl::expected<void, std::string> write_whole(
    const std::filesystem::path& file,
    const std::function<tl::expected<void, std::string>(const std::filesystem::path&)>& write);
[[nodiscard]] tl::expected<void, std::string> write_text(const std::filesystem::path& file,
                                                         const std::string& text);

}  // namespace alcove::sample
