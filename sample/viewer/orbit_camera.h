#pragma once

#include "scene/camera.h"

// How a mouse moves a camera about its target. Each function returns the moved camera; the eye
// never reaches the target.
namespace alcove::sample {

// Orbits the eye by `angles` in radians, x around the up vector and y over it, in the direction in
// which a hand would turn the scene. Stops before looking straight up or down.
[[nodiscard]] Camera turned(const Camera& camera, glm::vec2 angles);

// Moves eye and target so that the surface at the target follows a mouse that moves by `share` of
// the image's height (x right, y down).
[[nodiscard]] Camera panned(const Camera& camera, glm::vec2 share);

// Multiplies the distance of the eye from the target by `factor` (over 0); in an orthographic view
// the height that it shows.
[[nodiscard]] Camera dollied(const Camera& camera, float factor);

}  // namespace alcove::sample
