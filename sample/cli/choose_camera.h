#pragma once

#include "cli/options.h"
#include "scene/camera.h"
#include "scene/framing.h"
#include "support/result.h"

namespace alcove::sample {

constexpr const char* kNoCamera = "none";

// Whether the options leave the choice among the cameras of the scene.
[[nodiscard]] bool uses_default_camera(const ViewOptions& view);

// Returns the camera that the options choose in the scene of a finder. Near and far planes that are
// not given as options are those of the scene's camera. They are instead fitted to the geometry in
// view if the eye, the target or the height of an orthographic view is given, or if the scene has
// no camera. Without a camera and an eye, or with the name kNoCamera, the finder frames the scene.
// It also does if uses_default_camera() and that camera shows no subject. Depth is reversed in
// perspective views unless the options say otherwise. Errors: the scene has no camera of that name
// (its cameras are listed), the eye is at the target, the near plane is not in front of the far
// plane or, in perspective, not in front of the eye.
[[nodiscard]] Result<Camera> choose_camera(const ViewOptions& view, const ViewFinder& finder);

}  // namespace alcove::sample
