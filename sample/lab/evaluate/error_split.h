// The causes of the error of visibility in a static view.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluate/static_view.h"
#include "gpu/gpu.h"
#include "gpu/occlusion.h"
#include "scene/scene.h"
#include "support/glm.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// A cause of the error. A remedy removes it, on top of the remedies of the causes before.
struct ErrorCause {
  std::string key;   // in names of files and in report.json
  std::string name;  // in tables
  // The part of the mean squared error that the remedy removes, 0..1. It is negative if the remedy
  // raises the error; the causes after it are then measured without it.
  double share = 0;
  Image<float> before;  // visibility without the remedy
  Image<float> after;   // visibility with it
};

// The causes in this order: noise; filter, tiles and few steps; hidden surfaces that a second depth
// layer shows; thickness that back faces tell; occluders outside the image; the rest. Shares that
// are not negative add up to 1.
struct ErrorSplit {
  double rmse = 0;  // of visibility with the given settings, against scene truth
  std::vector<ErrorCause> causes;
};

// Splits the error of `settings` after StaticSetup::frames frames of a static view. Noise is half
// the mean squared difference between two sequences of frames. The other remedies are rendered: 8
// slices of at least 16 steps in each pixel without filter, averaged over 8 frames; the same with a
// second depth layer; with back faces; and as the middle of an image of twice the width and height.
// Errors: the settings do not allow a remedy, or a rendering fails.
[[nodiscard]] Result<ErrorSplit> split_error(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                                             const OcclusionSettings& settings,
                                             const Image<float>& truth, const Mask& surfaces);

// A line for each cause.
[[nodiscard]] std::string format_table(const ErrorSplit& split);
[[nodiscard]] nlohmann::ordered_json to_json(const ErrorSplit& split);

// Returns the change of visibility that the remedy causes, in the colours of error_colours(). The
// changes of all remedies that lower the error add up to the error.
[[nodiscard]] Image<glm::vec3> cause_picture(const ErrorCause& cause);
// Writes the picture of each cause as split_*.png.
[[nodiscard]] Result<void> write_pictures(const ErrorSplit& split,
                                          const std::filesystem::path& folder);

}  // namespace alcove::sample
