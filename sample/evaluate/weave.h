// The weave: a regular pattern in visibility that remains if the filter does not average all
// directions of interleaved sampling. It is visible on smooth surfaces, but an RMSE hides it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "support/image.h"

namespace alcove::sample {

// The pattern that repeats every 4 pixels in x and y, measured in windows of 32x32 pixels in which
// the truth is smooth. In each window the error, less its mean over 9x9 pixels, is averaged by
// (x mod 4, y mod 4). The variance of the pattern is that of the 16 averages, less the variance
// that white noise as strong as the error would give them, so that it is 0 on average without a
// pattern.
struct Weave {
  // A pattern with a larger RMS is visible: it is more than one step of 8 bits.
  static constexpr double kVisible = 0.005;

  std::uint64_t windows = 0;
  std::uint64_t visible_windows = 0;  // with a pattern over kVisible
  double variances = 0;               // sum over the windows

  // RMS of the pattern over all windows; 0 if there are no windows.
  double rms() const;
  double visible_fraction() const;
  Weave& operator+=(const Weave& more);
};

// All images have the same size. Windows with a pixel outside `surfaces` do not count.
[[nodiscard]] Weave weave_of(const Image<float>& result, const Image<float>& truth,
                             const Mask& surfaces);

// One line of a table, with its line break.
[[nodiscard]] std::string weave_line(const Weave& weave);
// The weave in the form of report.json.
[[nodiscard]] nlohmann::ordered_json to_json(const Weave& weave);

}  // namespace alcove::sample
