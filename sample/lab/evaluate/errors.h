#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "support/glm.h"
#include "support/image.h"

namespace alcove::sample {

// All images of a call have the same size.
struct ErrorSummary {
  uint64_t count = 0;  // pixels compared; everything is zero when there are none
  double rmse = 0;
  double mean_absolute = 0;
  double bias = 0;  // mean of result - truth
  double max_absolute = 0;
  double percentile_95 = 0;  // of the absolute error
};
// Compares an image of one channel with its truth. A pixel that is not finite in either counts as
// an error of 1.
[[nodiscard]] ErrorSummary compare_images(const Image<float>& result, const Image<float>& truth,
                                          const Mask& mask);
// Compares images of three channels with each other; each channel counts as a value.
[[nodiscard]] ErrorSummary compare_images(const Image<glm::vec3>& result,
                                          const Image<glm::vec3>& truth, const Mask& mask);

struct AngleSummary {
  uint64_t count = 0;
  double mean_degrees = 0;
  double percentile_95_degrees = 0;
};
// Summarises the angles between corresponding directions of two images. Directions may have any
// length above 0. Pixels without a true direction (a zero vector) are excluded; a zero vector in
// the result counts as 90 degrees.
[[nodiscard]] AngleSummary compare_directions(const Image<glm::vec3>& result,
                                              const Image<glm::vec3>& truth, const Mask& mask);

// The result at open surfaces, which are the pixels with a true visibility of at least 0.999.
struct OpenSurfaceSummary {
  uint64_t count = 0;
  double mean_visibility = 1;
  double fraction_below_95 = 0;  // fraction of those pixels with a result below 0.95
};
[[nodiscard]] OpenSurfaceSummary open_surfaces(const Image<float>& result,
                                               const Image<float>& truth, const Mask& mask);

// Returns an image of the signed error: white where there is none, red where the result is too
// dark, blue where it is too bright. The colours are saturated at an error of 0.25.
[[nodiscard]] Image<glm::vec3> error_colours(const Image<float>& result, const Image<float>& truth);

// One line of a table of errors.
[[nodiscard]] std::string error_row(std::string_view name, double rmse, double bias);

// The summaries in the form of report.json.
[[nodiscard]] nlohmann::ordered_json to_json(const ErrorSummary& summary);
[[nodiscard]] nlohmann::ordered_json to_json(const AngleSummary& summary);
[[nodiscard]] nlohmann::ordered_json to_json(const OpenSurfaceSummary& summary);

}  // namespace alcove::sample
