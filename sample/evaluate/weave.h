// A regular pattern in an image of visibility, as interleaved sampling leaves where its filter does
// not mix all of the directions: plain to the eye on smooth surfaces, and invisible to an RMSE.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "support/image.h"

namespace alcove::sample {

// The pattern that repeats every 4 pixels each way, over windows of 32x32 pixels in which the truth
// is smooth. In each window the error, less its mean over 9x9 pixels, is averaged by (x mod 4, y
// mod 4). The pattern's variance is that of the 16 averages, less what white noise of the error's
// own strength would give them: it is 0 in the mean for an error without a pattern.
struct Weave {
  // A pattern of this RMS is visible: more than one step of 8 bits.
  static constexpr double kVisible = 0.005;

  std::uint64_t windows = 0;
  std::uint64_t visible_windows = 0;  // with a pattern over kVisible
  double variances = 0;               // sum over the windows

  // RMS of the pattern over all windows; 0 where there is none.
  double rms() const;
  double visible_fraction() const;
  Weave& operator+=(const Weave& more);
};

// All images have one size. Windows with a pixel outside of `surfaces` do not count.
[[nodiscard]] Weave weave_of(const Image<float>& result, const Image<float>& truth,
                             const Mask& surfaces);

// For tables: one line, with its line break.
[[nodiscard]] std::string weave_line(const Weave& weave);
// As report.json has it.
[[nodiscard]] nlohmann::ordered_json to_json(const Weave& weave);

}  // namespace alcove::sample
