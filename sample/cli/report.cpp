#include "cli/report.h"

#include <fmt/format.h>

#include "render/settings_json.h"
#include "support/process_memory.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(glm::vec3 v) { return Json::array({v.x, v.y, v.z}); }

Json position_json(const Camera& camera, glm::vec3 position) {
  if (camera.origin == glm::dvec3(0.0)) return vector_json(position);
  const glm::dvec3 p = camera.origin + glm::dvec3(position);
  return Json::array({p.x, p.y, p.z});
}

Json camera_json(const Camera& camera) {
  Json json;
  // Positions are in the space of the scene's file, like --eye and --target.
  json["eye"] = position_json(camera, camera.eye_ws);
  json["target"] = position_json(camera, camera.target_ws);
  json["up"] = vector_json(camera.up_ws);
  if (camera.orthographic)
    json["ortho_height"] = camera.ortho_height;
  else
    json["fov_y_radians"] = camera.fov_y;
  json["near"] = camera.near_plane;
  // JSON has no infinity.
  json["far"] = std::isinf(camera.far_plane) ? Json("inf") : Json(camera.far_plane);
  json["reversed_z"] = camera.reversed_z;
  return json;
}

}  // namespace

Json rendering_report(const Rendering& rendering, const Options& options) {
  Json report;
  report["scene"] = rendering.scene.name;
  report["device"] = {{"name", rendering.device}, {"driver", rendering.driver}};
  report["size"] = {options.view.width, options.view.height};
  report["frames"] = options.view.frames;
  report["camera"] = camera_json(rendering.camera);
  report["normals"] = name_of(options.view.normals);
  report["settings"] = to_json(rendering.settings);
  for (const PassTime& pass : rendering.costs.passes)
    report["timings_ms"][pass.pass] = pass.milliseconds;
  report["timings_ms"]["total"] = rendering.costs.occlusion_ms;
  report["cpu_ms"] = rendering.costs.cpu_ms;
  report["memory"] = {{"transient_bytes", rendering.memory.aliased},
                      {"transient_bytes_without_aliasing", rendering.memory.unaliased},
                      {"transient_bytes_lower_bound", rendering.memory.lower_bound},
                      {"history_bytes", rendering.memory.history},
                      {"allocated_bytes", rendering.memory.allocated}};
  // Includes the main memory that the driver uses.
  if (const auto peak = peak_memory()) report["memory"]["peak_process_bytes"] = *peak;
  report["scene_triangles"] = triangle_count(rendering.scene);
  report["load_seconds"] = rendering.load_seconds;
  return report;
}

std::string time_table(const Rendering& rendering) {
  std::string text = fmt::format("{}, {}\n", rendering.device, rendering.driver);
  const auto row = [&](const std::string& name, double milliseconds) {
    text += fmt::format("  {:34}{:9.3f} ms\n", name, milliseconds);
  };
  for (const PassTime& pass : rendering.costs.passes) row(pass.pass, pass.milliseconds);
  row("occlusion, by GPU timestamps", rendering.costs.occlusion_ms);
  row("occlusion, processor time", rendering.costs.cpu_ms);
  return text + fmt::format("  transients {:.2f} MiB aliased, {:.2f} MiB without aliasing\n",
                            mib(rendering.memory.aliased), mib(rendering.memory.unaliased));
}

}  // namespace alcove::sample
