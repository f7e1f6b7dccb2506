#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "support/glm.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Light from infinitely far away, as an equirectangular image of linear RGB radiance, finite and at
// least 0. The top row is +Y, the left edge is -Z, and a quarter of the width further right is +X.
using EnvironmentImage = Image<glm::vec3>;

// Reads an OpenEXR file of at most 16384 pixels a side as 16-bit floats, and reduces it by a whole
// factor to at most 2048. Its display window is the sphere, which is black where the file has no
// data. An empty name gives the procedural sky. Radiance that is negative or NaN becomes 0, and
// radiance above the largest 16-bit float, 65504, becomes that, which `note` is called with a
// sentence about. The error is a sentence with the file's name: unreadable, damaged, or another
// format.
[[nodiscard]] Result<EnvironmentImage> load_environment(
    const std::filesystem::path& file, const std::function<void(const std::string&)>& note = {});

// Returns the unit direction of the centre of a pixel, given by its index.
[[nodiscard]] glm::vec3 direction_at(const EnvironmentImage& environment, size_t pixel);

// Returns the radiance from a unit direction in world space, interpolated bilinearly.
[[nodiscard]] glm::vec3 radiance(const EnvironmentImage& environment, const glm::vec3& direction);

// Returns the mean radiance over all directions.
[[nodiscard]] glm::vec3 mean_radiance(const EnvironmentImage& environment);

}  // namespace alcove::sample
