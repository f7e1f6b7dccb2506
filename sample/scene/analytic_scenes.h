#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// A point of an analytic scene and its visibility in closed form.
struct ReferencePoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;  // unit
  double visibility;    // cosine-weighted, 0..1
};

// A scene whose visibility is known in closed form. Its geometry is finite, so that the closed
// forms hold only if the radius of the occlusion is at least `closed_form_radius` and no ray
// reaches beyond the edges of the geometry.
struct AnalyticScene {
  Scene scene;
  double closed_form_radius;  // scene units
  std::vector<ReferencePoint> points;
};

constexpr const char* kAnalyticExamples = "plane:60, groove:90, corner, sphere, pit or step";

// Returns the scene of a name: `plane:DEG` (DEG is the tilt from facing the camera, 0..89, default
// 0), `groove:DEG` (DEG is the opening angle between the walls, 10..170, default 90), `corner`,
// `sphere`, `pit` or `step`. Lengths are metres. Unknown names and angles out of range are errors
// that list the valid ones.
[[nodiscard]] Result<AnalyticScene> analytic_scene(const std::string& name);

// Returns whether `name` begins like a name of analytic_scene(). Its angle may be out of range.
[[nodiscard]] bool is_analytic_name(const std::string& name);

}  // namespace alcove::sample
