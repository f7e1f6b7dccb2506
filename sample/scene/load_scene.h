#pragma once

#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// A scene by what the user typed: empty or `builtin`, an analytic scene (`plane:60`, `groove:90`,
// `corner`, `sphere`, `pit`, `step`), or the path of a .gltf or .glb file. Always has a camera.
// Errors are one sentence that names the scene and the remedy. With `cut_blends` materials that
// blend are cut out at half their alpha, else they are opaque; a warning says which.
[[nodiscard]] tl::expected<Scene, std::string> load_scene(const std::string& what,
                                                          bool cut_blends = false);

}  // namespace alcove::sample
