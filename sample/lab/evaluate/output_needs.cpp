#include "evaluate/output_needs.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

#include "evaluate/errors.h"
#include "maths/multi_bounce.h"

namespace alcove::sample {
namespace {

// Materials that cover a smaller part of the surfaces in view do not decide.
constexpr double kShare = 0.05;

double covered_share(const Mask& part, const Mask& whole) {
  const auto count = [](const Mask& mask) {
    return static_cast<double>(std::ranges::count_if(mask.pixels, [](auto p) { return p != 0; }));
  };
  return count(part) / std::max(count(whole), 1.0);
}

}  // namespace

Result<std::vector<std::string>> output_needs(const Scene& scene, const GBuffer& seen,
                                              const Truths& truths,
                                              const TimeIncrease& time_increase) {
  std::vector<std::string> sentences;
  if (scene.materials.size() < 2 && scene.images.empty()) return sentences;
  const Image<float>& visibility = truths.scene.visibility;
  const auto where = [&](const auto& choose) {
    Mask mask(visibility.width, visibility.height);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
      const bool surface = truths.surfaces.pixels[i] != 0 && seen.material.pixels[i] != kNoMaterial;
      mask.pixels[i] = surface && choose(i) ? 1 : 0;
    }
    return mask;
  };
  const auto material = [&](std::size_t i) -> const Material& {
    return scene.materials[seen.material.pixels[i]];
  };
  const Mask surfaces = where([](std::size_t) { return true; });
  const auto add = [&](bool needed, const char* name, const std::string& reason) {
    sentences.push_back(fmt::format("{}: {}{}", name, needed ? "" : "not needed here, ", reason));
  };

  // The outputs of the passes.
  const Mask glossy = where([&](std::size_t i) { return seen.roughness.pixels[i] < 0.5f; });
  const Image<float> open(visibility.width, visibility.height, 1.0f);
  ALCOVE_TRY(const double specular_time,
             time_increase([](OcclusionSettings& s) { s.specular = ALCOVE_SPECULAR_SLICES; }));
  add(covered_share(glossy, surfaces) > kShare, "specular occlusion (specular=slices)",
      fmt::format("{:.0f} % of the surfaces have a roughness below 0.5, and their visibility is "
                  "{:.2f} less than 1 on average; {:.0f} % more time",
                  100.0 * covered_share(glossy, surfaces),
                  compare_images(open, visibility, glossy).bias, 100.0 * specular_time));
  const AngleSummary angle =
      compare_directions(seen.shading_normal_ws, truths.scene.bent_normal_ws, surfaces);
  ALCOVE_TRY(const double bent_time,
             time_increase([](OcclusionSettings& s) { s.bent_normal = true; }));
  add(angle.mean_degrees > 5.0, "bent normals (bent_normal=true)",
      fmt::format("the mean unoccluded direction is {:.0f} degrees from the normal on average; "
                  "{:.0f} % more time",
                  angle.mean_degrees, 100.0 * bent_time));
  const auto grey = [](float value) { return glm::vec3(value); };
  const ErrorSummary light = compare_images(mapped(maths::multi_bounce, visibility, seen.albedo),
                                            mapped(grey, visibility), surfaces);
  add(light.rmse > 0.01, "multi-bounce with the albedo",
      fmt::format("it makes visibility {:.3f} brighter on average, with an RMS of {:.3f}; it takes "
                  "no pass of its own",
                  light.bias, light.rmse));

  // The inputs.
  const Mask mapped = where([&](std::size_t i) { return material(i).normal_texture.image >= 0; });
  add(covered_share(mapped, surfaces) > kShare, "normals as an input",
      fmt::format("{:.0f} % of the surfaces have a normal map, which depth does not show",
                  100.0 * covered_share(mapped, surfaces)));
  const Mask thin = where([&](std::size_t i) { return material(i).alpha_mode == AlphaMode::mask; });
  add(covered_share(thin, surfaces) > kShare, "settings for thin occluders",
      fmt::format(
          "{:.0f} % of the surfaces are cut out by their alpha; thickness, hidden occlusion "
          "and back faces above are measured with them",
          100.0 * covered_share(thin, surfaces)));
  add(scene.has_animations, "motion vectors as an input",
      scene.has_animations
          ? "the file has animations, and motion vectors follow what moves"
          : "nothing moves by itself, and the history follows the camera without them");
  return sentences;
}

Result<std::vector<std::string>> view_needs(const Session& session, const Truths& truths,
                                            const SettingTimes& times,
                                            const RecommendationGoal& goal,
                                            const Achievement& chosen) {
  ALCOVE_TRY(const auto rays, RayScene::create(session.scene));
  const GBuffer seen =
      cast_gbuffer(rays, session.camera, truths.surfaces.width, truths.surfaces.height);
  const TimeIncrease time_increase = [&](const auto& change) -> Result<double> {
    Achievement changed = chosen;
    change(changed.choice.settings);
    ALCOVE_TRY(changed.ms, times(changed.choice));
    return goal.ms(changed) / goal.ms(chosen) - 1.0;
  };
  return output_needs(session.scene, seen, truths, time_increase);
}

}  // namespace alcove::sample
