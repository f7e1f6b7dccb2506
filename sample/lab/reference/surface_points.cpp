#include "reference/surface_points.h"

#include <cmath>

namespace alcove::sample {

SurfacePoints surface_points(const RayScene& rays, const Camera& camera,
                             const Image<glm::vec3>& normal_ws, const Image<float>& depth) {
  const std::uint32_t width = depth.width;
  const std::uint32_t height = depth.height;
  const GBuffer cast = cast_gbuffer(rays, camera, width, height);
  const CameraMatrices matrices = camera_matrices(camera, width, height);
  SurfacePoints points{cast.position_ws, normal_ws, cast.geometric_normal_ws};
  const glm::vec3 forward = -glm::vec3(matrices.world_from_view[2]);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const float z = depth.at(x, y);
      if (!std::isfinite(z)) {
        points.normal_ws.at(x, y) = glm::vec3(0.0f);
      } else if (!std::isfinite(cast.depth_vs.at(x, y)) ||
                 std::abs(cast.depth_vs.at(x, y) - z) > 0.01f * z) {
        const Ray ray =
            camera_ray(matrices, camera.orthographic,
                       {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, width, height);
        points.position_ws.at(x, y) =
            ray.origin_ws + ray.direction_ws * (z / glm::dot(ray.direction_ws, forward));
        points.geometric_normal_ws.at(x, y) = normal_ws.at(x, y);
      }
    }
  }
  return points;
}

}  // namespace alcove::sample
