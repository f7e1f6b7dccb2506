#pragma once

#include "scene/camera.h"

// How a mouse moves a camera about its target. Each gives the moved camera; the eye never reaches
// the target.
namespace alcove::sample {

// Turns the eye by `angles` (radians) as if the scene were turned by hand: x about what is up, y
// over it, but never past looking straight up or down.
[[nodiscard]] Camera turned(const Camera& camera, glm::vec2 angles);

// Moves eye and target so that what lies at the target follows a mouse that moves by `share` of the
// image's height (x right, y down).
[[nodiscard]] Camera panned(const Camera& camera, glm::vec2 share);

// Moves the eye so that its distance from the target is `factor` (over 0) times what it was; an
// orthographic view shows so much more or less.
[[nodiscard]] Camera dollied(const Camera& camera, float factor);

}  // namespace alcove::sample
