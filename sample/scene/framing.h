#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// A camera that looks from above and one side at the core of a scene, as near as possible with all
// of the core in view. `aspect` is the width of the image over its height. If meshes enclose the
// core at a distance, such as a room, the eye stands within them if one of four sides has room for
// that. with_fitted_planes() is still to be applied.
[[nodiscard]] Camera framing_camera(const Scene& scene, double aspect);

}  // namespace alcove::sample
