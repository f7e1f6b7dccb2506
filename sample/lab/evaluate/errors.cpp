#include "evaluate/errors.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "support/median.h"

namespace alcove::sample {
namespace {

// Returns a summary of the differences between two images over all channels of all pixels of the
// mask. `get(image, pixel, channel)` reads a value.
template <class T, class Get>
ErrorSummary compare(const Image<T>& result, const Image<T>& truth, const Mask& mask, int channels,
                     const Get& get) {
  ErrorSummary out;
  double squares = 0.0;
  std::vector<float> sizes;
  for (size_t i = 0; i < mask.pixels.size(); ++i) {
    if (!mask.pixels[i]) continue;
    ++out.count;
    for (int c = 0; c < channels; ++c) {
      const double a = get(result, i, c), b = get(truth, i, c);
      const double error = std::isfinite(a) && std::isfinite(b) ? a - b : 1.0;
      squares += error * error;
      out.mean_absolute += std::abs(error);
      out.bias += error;
      out.max_absolute = std::max(out.max_absolute, std::abs(error));
      sizes.push_back(static_cast<float>(std::abs(error)));
    }
  }
  if (sizes.empty()) return out;
  const auto values = static_cast<double>(sizes.size());
  out.rmse = std::sqrt(squares / values);
  out.mean_absolute /= values;
  out.bias /= values;
  out.percentile_95 = percentile(std::move(sizes), 0.95);
  return out;
}

}  // namespace

ErrorSummary compare_images(const Image<float>& result, const Image<float>& truth,
                            const Mask& mask) {
  return compare(result, truth, mask, 1,
                 [](const Image<float>& image, size_t i, int) { return image.pixels[i]; });
}

ErrorSummary compare_images(const Image<glm::vec3>& result, const Image<glm::vec3>& truth,
                            const Mask& mask) {
  return compare(result, truth, mask, 3,
                 [](const Image<glm::vec3>& image, size_t i, int c) { return image.pixels[i][c]; });
}

AngleSummary compare_directions(const Image<glm::vec3>& result, const Image<glm::vec3>& truth,
                                const Mask& mask) {
  AngleSummary out;
  std::vector<float> angles;
  double sum = 0.0;
  for (size_t i = 0; i < mask.pixels.size(); ++i) {
    const glm::dvec3 a(result.pixels[i]), b(truth.pixels[i]);
    if (!mask.pixels[i] || b == glm::dvec3(0.0)) continue;
    // The arc tangent of sine and cosine is precise at small angles, unlike the arc cosine.
    double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    if (a == glm::dvec3(0.0) || !std::isfinite(angle)) angle = glm::half_pi<double>();
    sum += angle;
    angles.push_back(static_cast<float>(angle));
  }
  out.count = angles.size();
  if (angles.empty()) return out;
  out.mean_degrees = glm::degrees(sum / static_cast<double>(angles.size()));
  out.percentile_95_degrees = glm::degrees<double>(percentile(std::move(angles), 0.95));
  return out;
}

OpenSurfaceSummary open_surfaces(const Image<float>& result, const Image<float>& truth,
                                 const Mask& mask) {
  OpenSurfaceSummary out;
  double sum = 0.0, below = 0.0;
  for (size_t i = 0; i < mask.pixels.size(); ++i) {
    if (!mask.pixels[i] || !(truth.pixels[i] >= 0.999f)) continue;
    ++out.count;
    sum += result.pixels[i];
    if (!(result.pixels[i] >= 0.95f)) below += 1.0;
  }
  if (out.count == 0) return out;
  out.mean_visibility = sum / static_cast<double>(out.count);
  out.fraction_below_95 = below / static_cast<double>(out.count);
  return out;
}

Image<glm::vec3> error_colours(const Image<float>& result, const Image<float>& truth) {
  const auto colour = [](float a, float b) {
    const float error = 4.0f * (a - b), rest = 1.0f - std::fmin(std::fabs(error), 1.0f);
    return error < 0.0f ? glm::vec3(1.0f, rest, rest) : glm::vec3(rest, rest, 1.0f);
  };
  return mapped(colour, result, truth);
}

std::string error_row(std::string_view name, double rmse, double bias) {
  return fmt::format("  {:44}{:.4f}   bias {:+.4f}\n", name, rmse, bias);
}

nlohmann::ordered_json to_json(const ErrorSummary& summary) {
  return {{"pixels", summary.count},
          {"rmse", summary.rmse},
          {"bias", summary.bias},
          {"mean_absolute", summary.mean_absolute},
          {"percentile_95", summary.percentile_95},
          {"max_absolute", summary.max_absolute}};
}

nlohmann::ordered_json to_json(const AngleSummary& summary) {
  return {{"pixels", summary.count},
          {"mean_degrees", summary.mean_degrees},
          {"percentile_95_degrees", summary.percentile_95_degrees}};
}

nlohmann::ordered_json to_json(const OpenSurfaceSummary& summary) {
  return {{"pixels", summary.count},
          {"mean_visibility", summary.mean_visibility},
          {"fraction_below_0.95", summary.fraction_below_95}};
}

}  // namespace alcove::sample
