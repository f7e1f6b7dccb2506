#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "gpu/gpu.h"
#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// The window's image as it was read back, in a format that Swapchain chooses.
[[nodiscard]] Image<glm::vec3> screenshot(const HostBuffer& buffer, VkExtent2D size,
                                          VkFormat format);

// Writes it to view.png in the folder, or view-2.png and so on where there is one; returns the
// file. The folder is made; an empty one is where alcove was started.
[[nodiscard]] tl::expected<std::filesystem::path, std::string> write_screenshot(
    const std::filesystem::path& folder, const Image<glm::vec3>& image);

}  // namespace alcove::sample
