#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "gpu/gpu.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// Converts the bytes of a window's image, in a format that Swapchain chooses, to colours from 0 to
// 1, still encoded as sRGB.
[[nodiscard]] Image<glm::vec3> screenshot(const HostBuffer& buffer, VkExtent2D size,
                                          VkFormat format);

// Writes an image to view.png in the folder, or to view-2.png and so on if that file exists.
// Returns the path of the file. Creates the folder; an empty path is the current folder.
[[nodiscard]] tl::expected<std::filesystem::path, std::string> write_screenshot(
    const std::filesystem::path& folder, const Image<glm::vec3>& image);

}  // namespace alcove::sample
