#include "evaluate/lit_errors.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "render/display.h"
#include "support/image_io.h"

namespace alcove::sample {
namespace {

// The mean over the mask's pixels and the channels.
template <class Value>
double mean_over(const Mask& mask, const Image<glm::vec3>& image, const Value& value) {
  double total = 0.0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (mask.pixels[i] != 0) {
      for (int c = 0; c < 3; ++c) total += value(double{image.pixels[i][c]});
      count += 3;
    }
  }
  return count == 0 ? 0.0 : total / static_cast<double>(count);
}

// An image with one pixel for each block: the traced one, or a sky pixel if none was traced.
Image<glm::vec3> block_pixels(const Image<glm::vec3>& picture, const IndirectTruths& light,
                              const Image<float>& depth) {
  const std::uint32_t block = light.block;
  Image<glm::vec3> small((picture.width + block - 1) / block, (picture.height + block - 1) / block);
  for (const bool sky : {true, false}) {
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      for (std::uint32_t x = 0; x < picture.width; ++x)
        if (sky ? std::isinf(depth.at(x, y)) : light.sampled.at(x, y) != 0)
          small.at(x / block, y / block) = picture.at(x, y);
    }
  }
  return small;
}

void paste(const Image<glm::vec3>& tile, std::uint32_t left, std::uint32_t top,
           Image<glm::vec3>& canvas) {
  for (std::uint32_t y = 0; y < tile.height; ++y)
    for (std::uint32_t x = 0; x < tile.width; ++x) canvas.at(left + x, top + y) = tile.at(x, y);
}

// Returns an image of the signed error relative to `mean`: grey where there is no error, brighter
// where the result is too bright, and darker where it is too dark.
Image<glm::vec3> error_colours(const Image<glm::vec3>& result, const Image<glm::vec3>& truth,
                               double mean) {
  const auto unit = static_cast<float>(std::max(mean, 1e-9));
  return mapped([unit](glm::vec3 a, glm::vec3 b) { return 0.5f + (a - b) / unit; }, result, truth);
}

}  // namespace

LitErrors measure_lit_errors(const Rendering& rendering, const IndirectTruths& light) {
  const LitImages& images = rendering.images.lit;
  const Image<glm::vec3> truth = mapped(std::plus<>(), light.lit->diffuse, light.lit->specular);
  LitErrors errors;
  const auto variance_of = [&](const Image<glm::vec3>& noise) {
    return mean_over(light.sampled, noise, [](double x) { return x * x; });
  };
  const double diffuse_variance = variance_of(light.lit->diffuse_noise);
  const double specular_variance = variance_of(light.lit->specular_noise);
  const double variance = diffuse_variance + specular_variance;
  errors.mean_radiance = mean_over(light.sampled, truth, [](double x) { return x; });
  const double unit = 1.0 / std::max(errors.mean_radiance, 1e-9);
  errors.noise = std::sqrt(variance) * unit;
  const auto step = [&](const char* name, const Image<glm::vec3>& image,
                        const Image<glm::vec3>& against, double noise) {
    const ErrorSummary summary = compare_images(image, against, light.sampled);
    errors.pixels = summary.count;
    const double square = summary.rmse * summary.rmse - noise;
    return LitStep{name, std::sqrt(std::max(square, 0.0)) * unit, summary.bias * unit};
  };
  errors.steps = {step("without occlusion", images.unoccluded, truth, variance),
                  step("visibility, light along the bent normal", images.occluded, truth, variance),
                  step("and multi-bounce, also on specular light", images.bounced, truth, variance),
                  step("and specular occlusion on specular light", images.all, truth, variance)};
  errors.visibility_only = step("visibility alone", images.unbent, truth, variance);
  errors.diffuse =
      step("diffuse part of the last step", images.diffuse, light.lit->diffuse, diffuse_variance);
  errors.specular = step("specular part of the last step", images.specular, light.lit->specular,
                         specular_variance);
  return errors;
}

nlohmann::ordered_json to_json(const LitErrors& errors) {
  nlohmann::ordered_json json;
  json["pixels"] = errors.pixels;
  json["mean_radiance"] = errors.mean_radiance;
  json["noise_of_truth"] = errors.noise;
  const auto add = [](const LitStep& step) {
    return nlohmann::ordered_json{{"rmse", step.rmse}, {"bias", step.bias}};
  };
  for (const LitStep& step : errors.steps) json["steps"][step.name] = add(step);
  json["visibility_alone"] = add(errors.visibility_only);
  json["diffuse"] = add(errors.diffuse);
  json["specular"] = add(errors.specular);
  return {{"lit", json}};
}

std::string lit_error_table(const LitErrors& errors) {
  std::string text = fmt::format(
      "RMSE of the lit image over {} pixels, relative to its mean radiance {:.4f} (noise of the "
      "truth, subtracted: {:.4f})\n",
      errors.pixels, errors.mean_radiance, errors.noise);
  std::vector<LitStep> steps = errors.steps;
  steps.insert(steps.end(), {errors.visibility_only, errors.diffuse, errors.specular});
  for (const LitStep& step : steps) text += error_row(step.name, step.rmse, step.bias);
  return text;
}

Result<void> write_lit_steps(const Rendering& rendering, const IndirectTruths& light,
                             const std::filesystem::path& folder) {
  const LitImages& images = rendering.images.lit;
  const float exposure = exposure_of(rendering.light.environment);
  const Image<glm::vec3> truth = mapped(std::plus<>(), light.lit->diffuse, light.lit->specular);
  const double mean = mean_over(light.sampled, truth, [](double x) { return x; });
  const Image<float> depth = linear_depth(rendering);
  const auto tile = [&](const Image<glm::vec3>& picture) {
    return display_colours(block_pixels(with_sky(rendering, picture), light, depth), exposure);
  };
  const std::array tiles{tile(images.unoccluded),
                         tile(images.occluded),
                         tile(images.bounced),
                         tile(images.all),
                         tile(images.unbent),
                         tile(truth),
                         error_colours(block_pixels(images.all, light, depth),
                                       block_pixels(truth, light, depth), mean)};
  constexpr std::size_t kTruth = 5;
  constexpr std::uint32_t kColumns = 4;
  const std::uint32_t width = tiles[0].width + 2;
  const std::uint32_t height = tiles[0].height + 2;
  Image<glm::vec3> canvas(width * kColumns, height * 2, glm::vec3(1.0f));
  for (std::uint32_t i = 0; i < tiles.size(); ++i)
    paste(tiles[i], i % kColumns * width, i / kColumns * height, canvas);
  ALCOVE_TRY_VOID(write_png(folder / "lit_steps.png", canvas));
  ALCOVE_TRY_VOID(write_png(folder / "truth_lit.png", tiles[kTruth]));
  Image<glm::vec3> comparison(width * 3 - 2, tiles[0].height, glm::vec3(1.0f));
  paste(tiles[0], 0, 0, comparison);
  paste(tiles[3], width, 0, comparison);
  paste(tiles[kTruth], 2 * width, 0, comparison);
  return write_png(folder / "lit_comparison.png", comparison);
}

}  // namespace alcove::sample
