#pragma once

#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"
#include "support/progress.h"

namespace alcove::sample {

// How materials are taken that a depth buffer cannot show as they are.
struct MaterialTreatment {
  bool cut_blends = false;  // alpha-blended ones are cut out at half their alpha; else opaque
  bool both_sides = false;  // single-sided ones are drawn from behind too
};

// A scene by what the user typed: empty or `builtin`, an analytic scene (`plane:60`, `groove:90`,
// `corner`, `sphere`, `pit`, `step`), or the path of a .gltf or .glb file. Always has a camera.
// Errors are one sentence that names the scene and the remedy. A warning names each alpha-blended
// material.
[[nodiscard]] tl::expected<Scene, std::string> load_scene(const std::string& what,
                                                          const MaterialTreatment& treatment = {},
                                                          const Progress& progress = {});

}  // namespace alcove::sample
