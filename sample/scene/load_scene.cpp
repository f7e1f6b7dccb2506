#include "scene/load_scene.h"

#include "scene/analytic_scenes.h"
#include "scene/builtin_scene.h"
#include "scene/gltf.h"

namespace alcove::sample {

tl::expected<Scene, std::string> load_scene(const std::string& what) {
  if (what.empty() || what == "builtin") return builtin_scene();
  if (is_analytic_name(what)) {
    auto analytic = analytic_scene(what);
    if (!analytic) return tl::unexpected(analytic.error());
    return std::move(analytic->scene);
  }
  auto scene = load_gltf(what);
  if (!scene) return scene;
  if (scene->cameras.empty()) scene->cameras.push_back(framing_camera(scene->bounds_ws));
  return scene;
}

}  // namespace alcove::sample
