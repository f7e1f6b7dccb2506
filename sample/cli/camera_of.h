#pragma once

#include <string>
#include <tl/expected.hpp>

#include "cli/options.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace alcove::sample {

// The camera that the options ask of this scene. Near and far planes that are not typed are fitted
// to the geometry in view where the view is typed or frames the scene; otherwise they are those of
// the scene's camera. Depth is reversed in perspective views unless the options say otherwise.
// Errors: a camera the scene does not have (its
// names are listed), an eye at the target, near not before far or in perspective not above 0.
[[nodiscard]] tl::expected<Camera, std::string> camera_of(const ViewOptions& view,
                                                          const Scene& scene);

}  // namespace alcove::sample
