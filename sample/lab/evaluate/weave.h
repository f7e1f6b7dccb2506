// The weave: a regular pattern in visibility that remains if the filter does not average all
// directions of interleaved sampling. It is visible on smooth surfaces, but an RMSE hides it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "support/image.h"

namespace alcove::sample {

// Patterns with a period of 2 to 9 pixels in any direction, measured by the power spectrum of the
// error in overlapping windows of 32x32 pixels in which the truth is smooth. A regular pattern
// gathers its variance at a few frequencies, whereas noise spreads it over all frequencies of a
// similar length. The variance of the pattern is therefore the power of those frequencies that
// stand out from the others, less the noise there. It is 0 for noise, whose spectrum may have any
// colour.
struct Weave {
  // A pattern with a larger RMS is visible: it is more than one step of 8 bits.
  static constexpr double kVisible = 0.005;

  std::uint64_t windows = 0;
  std::uint64_t visible_windows = 0;  // with a pattern over kVisible
  std::vector<double> powers;         // spectra, summed over the windows; empty without windows

  // RMS of the pattern over all windows, from their mean spectrum; 0 if there are no windows. The
  // more windows, the weaker the patterns that stand out: among white noise of a standard deviation
  // of 0.02, about 0.0025 in one window and 0.001 in a hundred.
  double rms() const;
  // Distance in pixels between the crests of the strongest wave of the pattern; 0 without a
  // pattern.
  double period() const;
  double visible_fraction() const;
  // The grain: RMS of the error with periods of 3 to 24 pixels, noise and patterns alike, over all
  // windows; 0 if there are none.
  double grain() const;
  Weave& operator+=(const Weave& more);
};

// All images have the same size. Windows with a pixel outside `surfaces`, or with a value that is
// not finite, do not count.
[[nodiscard]] Weave measure_weave(const Image<float>& result, const Image<float>& truth,
                                  const Mask& surfaces);

// One line of a table, with its line break: weave and grain.
[[nodiscard]] std::string weave_line(const Weave& weave);
// The weave in the form of report.json.
[[nodiscard]] nlohmann::ordered_json to_json(const Weave& weave);

}  // namespace alcove::sample
