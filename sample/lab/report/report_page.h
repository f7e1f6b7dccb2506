#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "support/glm.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Returns an HTML page that shows `data` and loads nothing else: page.html says what it expects. It
// contains Chart.js, which is read from the Debian package libjs-chart.js. Error: the package is
// not installed.
[[nodiscard]] Result<std::string> report_page(const nlohmann::ordered_json& data);

// Returns the image as a PNG in a data URI. `folder` receives a temporary file.
[[nodiscard]] Result<std::string> data_uri(const Image<float>& image,
                                           const std::filesystem::path& folder);
[[nodiscard]] Result<std::string> data_uri(const Image<glm::vec3>& image,
                                           const std::filesystem::path& folder);

}  // namespace alcove::sample
