// Computes the camera matrices of the host program with GLM, as engines do. The source is compiled
// with fused multiply-adds and -ffast-math if the compiler supports them, so that the matrices have
// the rounding errors of such builds.
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
