#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include "camera.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene.h"

namespace host {

CameraMatrices camera_matrices(glm::vec3 start, float angle, float aspect) {
  const glm::quat orbit = glm::angleAxis(angle, glm::vec3(0.0f, 1.0f, 0.0f));
  const glm::vec3 eye = kTarget + orbit * (start - kTarget);
  const glm::quat rotation = glm::quatLookAt(glm::normalize(kTarget - eye), glm::vec3(0, 1, 0));
  const glm::mat4 world_from_camera =
      glm::translate(glm::mat4(1.0f), eye) * glm::mat4_cast(rotation);
  CameraMatrices matrices;
  matrices.view = glm::inverse(world_from_camera);
  matrices.projection = glm::perspective(glm::radians(kFovYDegrees), aspect, kNear, kFar);
  matrices.projection[1][1] *= -1.0f;
  return matrices;
}

}  // namespace host
