#pragma once

#include "scene/environment.h"
#include "support/image.h"

namespace alcove::sample {

// Conversion of radiance to displayed colours. exposure_of() returns the factor by which radiance
// is multiplied, so that a white surface under the mean light of the environment appears bright but
// not white. display_colours() applies the factor, the tone curve 1 - exp(-x), and the sRGB
// encoding.
[[nodiscard]] float exposure_of(const EnvironmentImage& environment);
[[nodiscard]] Image<glm::vec3> display_colours(const Image<glm::vec3>& radiance, float exposure);

}  // namespace alcove::sample
