#include "scene/load_scene.h"

#include <filesystem>
#include <system_error>

#include "scene/analytic_scenes.h"
#include "scene/builtin_scene.h"
#include "scene/gltf.h"
#include "scene/outdoor_scenes.h"
#include "support/printable.h"

namespace alcove::sample {

namespace {

void treat_materials(Scene& scene, const MaterialTreatment& treatment) {
  for (Material& material : scene.materials) {
    if (treatment.both_sides) material.double_sided = true;
    if (material.alpha_mode != AlphaMode::blend || material.base_color.a == 0.0f) continue;
    scene.warnings.push_back(
        "Material \"" + material.name + "\" is alpha-blended: it is rendered " +
        (treatment.cut_blends ? "where its alpha is at least a half, and cut out elsewhere."
                              : "opaque (--cut-blends cuts it out)."));
    if (!treatment.cut_blends) continue;
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.5f;
  }
}

}  // namespace

Result<Scene> load_scene(const std::string& what, const MaterialTreatment& treatment,
                         const Progress& progress) {
  if (what.empty() || what == "builtin") return builtin_scene();
  if (what == "fence") return fence_scene();
  if (what == "terrain") return terrain_scene();
  if (is_analytic_name(what)) {
    return analytic_scene(what).map([](AnalyticScene&& it) { return std::move(it.scene); });
  }
  const std::filesystem::path file = what;
  std::error_code ignored;
  if (!file.has_extension() && !std::filesystem::exists(file, ignored)) {
    return Failure("there is no file and no scene " + printable(what) +
                   "; scenes that need no file are builtin, fence, terrain, " + kAnalyticExamples);
  }
  ALCOVE_TRY(auto scene, load_gltf(file, progress));
  treat_materials(scene, treatment);
  return scene;
}

}  // namespace alcove::sample
