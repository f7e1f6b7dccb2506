#include "evaluate/indirect_errors.h"

#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gtso_table.h"
#include "maths/gtso.h"
#include "maths/multi_bounce.h"
#include "tables/gtso.h"

namespace alcove::sample {
namespace {

// Returns the specular occlusion that the table has for visibility and bent normal.
float specular_by_table(float visibility, const glm::vec3& bent, const glm::vec3& normal,
                        const glm::vec3& view, float roughness) {
  const glm::vec3 mirror = maths::mirror_direction(normal, view);
  const glm::vec3 raised = maths::raised_bent_normal(bent, normal, visibility);
  return passes::look_up_gtso(kGtsoTable, visibility, maths::visibility_cone(visibility),
                              maths::angle_between(raised, mirror),
                              maths::angle_between(normal, mirror), roughness);
}

// The table applied to the true visibility and bent normal.
Image<float> specular_from_truth(const Rendering& rendering, const OcclusionTruth& truth,
                                 const IndirectTruths& light, const Image<float>& roughness) {
  const Viewer viewer = make_viewer(rendering.camera);
  Image<float> result(roughness.width, roughness.height, 1.0f);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    if (light.sampled.pixels[i] != 0) {
      const glm::vec3 view = view_from(viewer, light.points.position_ws.pixels[i]);
      result.pixels[i] =
          specular_by_table(truth.visibility.pixels[i], truth.bent_normal_ws.pixels[i],
                            light.points.normal_ws.pixels[i], view, roughness.pixels[i]);
    }
  }
  return result;
}

// Returns the smallest RMSE that any function of visibility and albedo can have. Values (channels
// of pixels) whose visibility and albedo are equal after quantisation form a cell. The result is
// the RMS deviation of the truth from the mean of its cell.
double least_spread(const Image<float>& visibility, const Image<glm::vec3>& albedo,
                    const Image<glm::vec3>& truth, const Mask& mask) {
  constexpr int kVisibilities = 64;
  constexpr int kAlbedos = 16;
  struct Cell {
    double count = 0, sum = 0, squares = 0;
  };
  std::vector<Cell> cells(std::size_t{kVisibilities} * kAlbedos);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    for (int c = 0; mask.pixels[i] != 0 && c < 3; ++c) {
      const auto x = std::lround(visibility.pixels[i] * (kVisibilities - 1));
      const auto y = std::lround(albedo.pixels[i][c] * (kAlbedos - 1));
      Cell& cell = cells[static_cast<std::size_t>(y * kVisibilities + x)];
      const double value = truth.pixels[i][c];
      cell.count += 1;
      cell.sum += value;
      cell.squares += value * value;
    }
  }
  double squares = 0, count = 0;
  for (const Cell& cell : cells) {
    // A cell with a single value has no spread. Dividing by n - 1 instead of n (Bessel's
    // correction) removes the bias that arises because the mean is computed from the same few
    // values.
    if (cell.count > 1) {
      const double own = cell.squares - cell.sum * cell.sum / cell.count;
      squares += own * cell.count / (cell.count - 1);
      count += cell.count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace

IndirectErrors measure_indirect_errors(const Rendering& rendering, const Truths& truths,
                                       const IndirectTruths& light) {
  const FrameImages& images = rendering.images;
  const Image<float>& visibility = truths.scene.visibility;
  IndirectErrors errors;
  errors.bounced = compare_images(images.multi_bounce, light.interreflection, light.sampled);
  errors.bounced_truth = compare_images(mapped(maths::multi_bounce, visibility, images.albedo),
                                        light.interreflection, light.sampled);
  const auto grey = [](float value) { return glm::vec3(value); };
  errors.unbounced_truth =
      compare_images(mapped(grey, visibility), light.interreflection, light.sampled);
  errors.bounced_best =
      least_spread(visibility, images.albedo, light.interreflection, light.sampled);
  const std::vector<Image<float>> roughness = roughness_images(rendering);
  const Image<float> open(visibility.width, visibility.height, 1.0f);
  for (std::size_t i = 0; i < roughness.size(); ++i) {
    const Image<float>& truth = light.specular[i];
    errors.specular.push_back(
        {roughness_name(rendering.light, i),
         compare_images(images.specular_occlusion[i], truth, light.sampled),
         compare_images(specular_from_truth(rendering, truths.scene, light, roughness[i]), truth,
                        light.sampled),
         compare_images(open, truth, light.sampled)});
  }
  return errors;
}

nlohmann::ordered_json to_json(const IndirectErrors& errors) {
  nlohmann::ordered_json json;
  json["multi_bounce"] = {{"pipeline", to_json(errors.bounced)},
                          {"true_visibility", to_json(errors.bounced_truth)},
                          {"true_visibility_unbounced", to_json(errors.unbounced_truth)},
                          {"true_visibility_best_rmse", errors.bounced_best}};
  for (const SpecularErrors& one : errors.specular) {
    json["specular_occlusion"][one.name] = {{"pipeline", to_json(one.pipeline)},
                                            {"true_inputs", to_json(one.true_inputs)},
                                            {"none", to_json(one.none)}};
  }
  return json;
}

std::string indirect_error_table(const IndirectErrors& errors) {
  std::string text = fmt::format(
      "RMSE of multi-bounce over {} pixels: {:.4f} (the polynomial of the true visibility {:.4f}, "
      "the best function of visibility and albedo {:.4f}, the true visibility itself {:.4f})\n",
      errors.bounced.count, errors.bounced.rmse, errors.bounced_truth.rmse, errors.bounced_best,
      errors.unbounced_truth.rmse);
  for (const SpecularErrors& one : errors.specular) {
    text += fmt::format(
        "RMSE of specular occlusion, {:10}{:.4f} (with true visibility and bent normal {:.4f}, "
        "without occlusion {:.4f})\n",
        one.name, one.pipeline.rmse, one.true_inputs.rmse, one.none.rmse);
  }
  return text;
}

}  // namespace alcove::sample
