#pragma once

#include "scene/camera.h"

// Camera movements for a mouse. Each function returns the moved camera. The eye never reaches the
// target.
namespace alcove::sample {

// Orbits the eye about the target by `angles` in radians: x about the up vector, y towards it. The
// scene turns in the direction of the mouse. Stops before the view direction is the up vector.
[[nodiscard]] Camera turned(const Camera& camera, glm::vec2 angles);

// Moves eye and target so that the point at the target follows the mouse. `share` is the movement
// of the mouse as a fraction of the image's height, x right, y down.
[[nodiscard]] Camera panned(const Camera& camera, glm::vec2 share);

// Multiplies the distance from the eye to the target by `factor` (above 0), in an orthographic view
// the height of the view.
[[nodiscard]] Camera dollied(const Camera& camera, float factor);

}  // namespace alcove::sample
