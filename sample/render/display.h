#pragma once

#include "scene/environment.h"
#include "support/image.h"

namespace alcove::sample {

// Radiance as it is shown: what an environment's light is multiplied with, so that a white surface
// in its mean comes out bright but not white; then the shoulder and sRGB.
[[nodiscard]] float exposure_of(const EnvironmentImage& environment);
[[nodiscard]] Image<glm::vec3> display_colours(const Image<glm::vec3>& radiance, float exposure);

}  // namespace alcove::sample
