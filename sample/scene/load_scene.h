#pragma once

#include <string>

#include "scene/scene.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

// How materials are drawn that a depth buffer cannot represent as the file describes them.
struct MaterialTreatment {
  bool cut_blends =
      false;  // alpha-blended materials are cut out below an alpha of 0.5; otherwise opaque
  bool both_sides = false;  // single-sided materials are drawn from behind too
};

// Loads a scene by the name that the user typed: empty or `builtin`, `fence`, `terrain`, an
// analytic scene (`plane:60`, `groove:90`, `corner`, `sphere`, `pit`, `step`), or the path of a
// .gltf or .glb file. A scene from a file has only the cameras of the file. Errors are one sentence
// that names the scene and the remedy. The scene's warnings name each alpha-blended material.
[[nodiscard]] Result<Scene> load_scene(const std::string& what,
                                       const MaterialTreatment& treatment = {},
                                       const Progress& progress = {});

}  // namespace alcove::sample
