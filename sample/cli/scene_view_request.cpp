#include "cli/scene_view_request.h"

#include <memory>
#include <utility>

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
  if (!options.occlusion.roughness.empty()) request.roughness = options.occlusion.roughness.front();
  request.guard_band = options.occlusion.guard_band;
  request.environment = options.environment;
  request.screenshots = options.out;
  request.open_session = [options](const std::vector<const char*>& surface_extensions) {
    return open_session(options, surface_extensions);
  };
  // The options of the scene that the window shows. Dropping a file on the window changes them.
  const auto shown = std::make_shared<Options>(options);
  request.load_session = [shown](const std::string& file) {
    Options other = *shown;
    other.scene = file;
    // A view, depth range or radius that was given for one scene does not suit another.
    other.view.camera.clear();
    other.view.eye.reset();
    other.view.target.reset();
    other.view.up_ws.reset();
    other.view.near_plane.reset();
    other.view.far_plane.reset();
    other.occlusion.radius.reset();
    auto session = load_session(other);
    if (session) *shown = std::move(other);
    return session;
  };
  request.command = [shown](const Shot& shot) {
    return shell_line(render_arguments(*shown, shot));
  };
  return request;
}

}  // namespace alcove::sample
