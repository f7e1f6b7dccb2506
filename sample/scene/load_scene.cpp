#include "scene/load_scene.h"

#include "scene/analytic_scenes.h"
#include "scene/builtin_scene.h"
#include "scene/gltf.h"

namespace alcove::sample {

namespace {

void treat_blends(Scene& scene, bool cut) {
  for (Material& material : scene.materials) {
    if (material.alpha_mode != AlphaMode::kBlend) continue;
    const std::string how = cut ? " blends: it is cut out where alpha is below a half."
                                : " blends: it is taken to be opaque (--cut-blends cuts it out).";
    scene.warnings.push_back("Material \"" + material.name + "\"" + how);
    if (!cut) continue;
    material.alpha_mode = AlphaMode::kMask;
    material.alpha_cutoff = 0.5f;
  }
}

}  // namespace

tl::expected<Scene, std::string> load_scene(const std::string& what, bool cut_blends) {
  if (what.empty() || what == "builtin") return builtin_scene();
  if (is_analytic_name(what)) {
    auto analytic = analytic_scene(what);
    if (!analytic) return tl::unexpected(analytic.error());
    return std::move(analytic->scene);
  }
  auto scene = load_gltf(what);
  if (!scene) return scene;
  treat_blends(*scene, cut_blends);
  if (scene->cameras.empty()) scene->cameras.push_back(framing_camera(scene->bounds_ws));
  return scene;
}

}  // namespace alcove::sample
