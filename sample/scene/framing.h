#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// A camera that looks from above and one side at the core of a scene, so that all of the core is in
// view. If meshes enclose the core at a distance, such as a room, the eye stands within them where
// one of four sides has room for that. with_fitted_planes() is still to be applied.
[[nodiscard]] Camera framing_camera(const Scene& scene);

}  // namespace alcove::sample
