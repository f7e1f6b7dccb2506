#include <memory>
#include <utility>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "support/result.h"
#include "support/whole_file.h"
#include "viewer/scene_view.h"

namespace alcove::sample {

SceneViewRequest scene_view_request(const Options& options) {
  SceneViewRequest request;
  static_cast<ViewRequest&>(request) = options.view;
  request.title = "alcove: " + (options.scene.empty() ? "builtin" : options.scene);
  if (!options.occlusion.roughness.empty()) request.roughness = options.occlusion.roughness.front();
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

Result<void> run_view(const Options& options) {
  if (!options.out.empty()) ALCOVE_TRY_VOID(create_folder(options.out));
  ALCOVE_TRY(auto view, SceneView::create(scene_view_request(options)));
  const std::uint32_t frames = options.view.frames;
  while (frames == 0 || view->drawn_frames() < frames) {
    if (view->drawn_frames() + 1 == frames && !options.out.empty()) view->take_screenshot();
    ALCOVE_TRY(const auto drawn, view->draw());
    if (!drawn) break;
  }
  return check_validation(view->gpu());
}

}  // namespace alcove::sample
