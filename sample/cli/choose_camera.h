#pragma once

#include <string>

#include "cli/options.h"
#include "scene/camera.h"
#include "scene/framing.h"
#include "support/result.h"

namespace alcove::sample {

// Returns the camera that the options choose in the scene of a finder. Near and far planes that are
// not given as options are those of the scene's camera. They are instead fitted to the geometry in
// view if the eye, the target or the height of an orthographic view is given, or if the scene has
// no camera. Without a camera and an eye, the finder frames the scene. Depth is reversed in
// perspective views unless the options say otherwise. Errors: the scene has no camera of that name
// (its cameras are listed), the eye is at the target, the near plane is not in front of the far
// plane or, in perspective, not in front of the eye.
[[nodiscard]] Result<Camera> choose_camera(const ViewOptions& view, const ViewFinder& finder);

}  // namespace alcove::sample
