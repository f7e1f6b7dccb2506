// The camera of the host program, as engines with GLM have it. Compiled with fused multiply-adds
// and -ffast-math where the compiler has them, so that its matrices have the rounding errors of
// such builds.
#pragma once

#include <glm/glm.hpp>

namespace host {

struct CameraMatrices {
  glm::mat4 projection;  // y down and depth 0 to 1, as Vulkan's clip space
  glm::mat4 view;
};

// The camera at `eye`, turned by `angle` radians about the vertical axis through the target.
[[nodiscard]] CameraMatrices camera_matrices(glm::vec3 eye, float angle, float aspect);

}  // namespace host
