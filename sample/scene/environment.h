#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// Light from infinitely far as an equirectangular image: linear RGB radiance, finite and at least
// 0, top row up (+Y), the left edge at -Z and a quarter to the right +X.
using EnvironmentImage = Image<glm::vec3>;

// A hazy sky, bright towards a low sun, over brown ground; no sun disc: that is direct light. Its
// mean radiance is about 1.
[[nodiscard]] EnvironmentImage procedural_sky();

// A .hdr (Radiance) or .exr file, brought down to at most 2048 columns by whole factors; an empty
// name gives the procedural sky. Radiance that is not finite or below 0 counts as 0. Errors, one
// sentence with the file's name: one that cannot be read, is damaged, or of another kind.
[[nodiscard]] tl::expected<EnvironmentImage, std::string> load_environment(
    const std::filesystem::path& file);

// Radiance from a unit direction, bilinear.
[[nodiscard]] glm::vec3 radiance(const EnvironmentImage& environment, const glm::vec3& direction);

// Over all directions.
[[nodiscard]] glm::vec3 mean_radiance(const EnvironmentImage& environment);

}  // namespace alcove::sample
