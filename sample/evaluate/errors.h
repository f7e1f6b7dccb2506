#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// All images of a call have one size.
struct ErrorSummary {
  uint64_t count = 0;  // pixels compared; everything is zero when there are none
  double rmse = 0;
  double mean_absolute = 0;
  double bias = 0;  // mean of result - truth
  double max_absolute = 0;
  double percentile_95 = 0;  // of the absolute error
};
// Of a channel image against its truth; pixels where either is not finite count as an error of 1.
[[nodiscard]] ErrorSummary compare_images(const Image<float>& result, const Image<float>& truth,
                                          const Mask& mask);
// The same over all three channels at once.
[[nodiscard]] ErrorSummary compare_images(const Image<glm::vec3>& result,
                                          const Image<glm::vec3>& truth, const Mask& mask);

struct AngleSummary {
  uint64_t count = 0;
  double mean_degrees = 0;
  double percentile_95_degrees = 0;
};
// Between directions of any positive length; pixels where the truth is zero are left out, a zero
// result counts as 90 degrees.
[[nodiscard]] AngleSummary compare_directions(const Image<glm::vec3>& result,
                                              const Image<glm::vec3>& truth, const Mask& mask);

// How well open surfaces stay open: over the pixels whose truth is at least 0.999.
struct OpenSurfaceSummary {
  uint64_t count = 0;
  double mean_visibility = 1;
  double fraction_below_95 = 0;  // of those pixels, whose result is under 0.95
};
[[nodiscard]] OpenSurfaceSummary open_surfaces(const Image<float>& result,
                                               const Image<float>& truth, const Mask& mask);

// Signed error as colours: white where right, red where too dark, blue where too bright, full
// colour at an error of a quarter.
[[nodiscard]] Image<glm::vec3> error_colours(const Image<float>& result, const Image<float>& truth);

// One line of a table of errors.
[[nodiscard]] std::string error_row(std::string_view name, double rmse, double bias);

// As report.json has them.
[[nodiscard]] nlohmann::ordered_json to_json(const ErrorSummary& summary);
[[nodiscard]] nlohmann::ordered_json to_json(const AngleSummary& summary);
[[nodiscard]] nlohmann::ordered_json to_json(const OpenSurfaceSummary& summary);

}  // namespace alcove::sample
