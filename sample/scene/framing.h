#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// Returns a camera that looks at the core of a scene from above and from one side, as near as
// possible with the whole core in view. `aspect` is the width of the image divided by its height.
// If meshes such as a room enclose the core at a distance, the eye is inside them, if one of four
// sides has room for it. Call with_fitted_planes() afterwards.
[[nodiscard]] Camera framing_camera(const Scene& scene, double aspect);

}  // namespace alcove::sample
