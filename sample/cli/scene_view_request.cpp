#include "cli/scene_view_request.h"

#include "cli/open_session.h"
#include "cli/render_command.h"

namespace alcove::sample {

SceneViewRequest scene_view_request(const Options& options) {
  SceneViewRequest request;
  request.width = options.view.width;
  request.height = options.view.height;
  request.title = "alcove: " + (options.scene.empty() ? "builtin" : options.scene);
  request.orbit = options.view.orbit;
  request.normals = options.occlusion.normals;
  if (!options.occlusion.roughness.empty()) {
    request.roughness = options.occlusion.roughness.front();
  }
  request.environment = options.environment;
  request.screenshots = options.out;
  request.open_session = [options](const std::vector<const char*>& surface_extensions) {
    return open_session(options, surface_extensions);
  };
  request.command = [options](const Shot& shot) {
    return shell_line(render_arguments(options, shot));
  };
  return request;
}

}  // namespace alcove::sample
