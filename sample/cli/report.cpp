#include "cli/report.h"

#include <iomanip>
#include <limits>
#include <sstream>

#include "alcove/passes/setting_names.h"
#include "render/settings_json.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(glm::vec3 v) { return Json::array({v.x, v.y, v.z}); }

Json camera_json(const Camera& camera) {
  Json json;
  json["eye"] = vector_json(camera.eye_ws);
  json["target"] = vector_json(camera.target_ws);
  json["up"] = vector_json(camera.up_ws);
  if (camera.orthographic) {
    json["ortho_height"] = camera.ortho_height;
  } else {
    json["fov_y_radians"] = camera.fov_y;
  }
  json["near"] = camera.near_plane;
  // JSON has no infinity.
  json["far"] = std::isinf(camera.far_plane) ? Json("inf") : Json(camera.far_plane);
  json["reversed_z"] = camera.reversed_z;
  return json;
}

Json costs_json(const Costs& costs) {
  Json json;
  for (const PassTime& pass : costs.passes) {
    json["timings_ms"][pass.pass] = pass.milliseconds;
  }
  json["timings_ms"]["total"] = costs.occlusion_ms;
  json["cpu_ms"] = costs.cpu_ms;
  return json;
}

}  // namespace

Json report_of(const Rendering& rendering, const Options& options) {
  Json report;
  report["scene"] = rendering.scene.name;
  report["device"] = {{"name", rendering.device}, {"driver", rendering.driver}};
  report["size"] = {options.view.width, options.view.height};
  report["frames"] = options.view.frames;
  report["camera"] = camera_json(rendering.camera);
  report["normals"] = name_of(options.occlusion.normals);
  report["settings"] = to_json(rendering.settings);
  report.update(costs_json(rendering.costs));
  report["with_specular"] = costs_json(rendering.costs_with_specular);
  report["with_specular"]["model"] = passes::name_of(specular_model(rendering.settings));
  report["memory"] = {{"transient_bytes", rendering.memory.aliased},
                      {"transient_bytes_without_aliasing", rendering.memory.unaliased},
                      {"transient_bytes_lower_bound", rendering.memory.lower_bound},
                      {"history_bytes", rendering.memory.history},
                      {"allocated_bytes", rendering.memory.allocated}};
  return report;
}

std::string time_table(const Rendering& rendering) {
  std::ostringstream text;
  text << rendering.device << ", " << rendering.driver << "\n" << std::fixed;
  const auto row = [&](const std::string& name, double milliseconds) {
    text << "  " << std::left << std::setw(34) << name << std::right << std::setw(9)
         << std::setprecision(3) << milliseconds << " ms\n";
  };
  for (const PassTime& pass : rendering.costs.passes) {
    row(pass.pass, pass.milliseconds);
  }
  row("occlusion, by GPU timestamps", rendering.costs.occlusion_ms);
  row("occlusion, processor time", rendering.costs.cpu_ms);
  row("with specular, by GPU timestamps", rendering.costs_with_specular.occlusion_ms);
  row("with specular, processor time", rendering.costs_with_specular.cpu_ms);
  text << std::setprecision(2) << "  transients " << mib(rendering.memory.aliased)
       << " MiB aliased, " << mib(rendering.memory.unaliased) << " MiB each on its own\n";
  return text.str();
}

}  // namespace alcove::sample
