#include "evaluate/weave.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kWindow = 32;
constexpr std::uint32_t kStep = kWindow / 2;  // between windows
constexpr std::size_t kBins = std::size_t{kWindow} * kWindow;
constexpr double kPi = 3.14159265358979323846;
constexpr double kLongestPeriod = 9.0;  // pixels; of the weave
constexpr double kShortestGrain = 3.0;  // periods, pixels
constexpr double kLongestGrain = 24.0;
// Number of next lower and of next higher frequencies with which a frequency is compared.
constexpr std::size_t kSimilar = 60;
// The truth of a window is smooth if the means of its 4x4 blocks, less a plane fitted to them, have
// at most this RMS. Contact shadows and silhouettes have more; the noise of 256 rays per pixel has
// a quarter of it.
constexpr double kSmooth = 0.02;

using Window = std::array<double, kBins>;  // rows of pixels, or of frequencies

// The values less a plane fitted to them.
Window without_plane(const Window& values) {
  const auto place = [](std::uint32_t i) { return i - 0.5 * (kWindow - 1); };
  double mean = 0;
  double slope_x = 0;
  double slope_y = 0;
  double squared_places = 0;
  for (std::uint32_t i = 0; i < kBins; ++i) {
    const double x = place(i % kWindow);
    mean += values[i] / kBins;
    slope_x += values[i] * x;
    slope_y += values[i] * place(i / kWindow);
    squared_places += x * x;
  }
  Window rest;
  for (std::uint32_t i = 0; i < kBins; ++i) {
    rest[i] = values[i] - mean -
              (slope_x * place(i % kWindow) + slope_y * place(i / kWindow)) / squared_places;
  }
  return rest;
}

// The image in the window whose upper left pixel is (left, top).
Window read_window(const Image<float>& image, std::uint32_t left, std::uint32_t top) {
  Window window;
  for (std::uint32_t y = 0; y < kWindow; ++y)
    for (std::uint32_t x = 0; x < kWindow; ++x)
      window[y * kWindow + x] = image.at(left + x, top + y);
  return window;
}

bool all_surfaces(const Mask& surfaces, std::uint32_t left, std::uint32_t top) {
  for (std::uint32_t y = top; y < top + kWindow; ++y) {
    const auto* row = &surfaces.at(left, y);
    if (std::find(row, row + kWindow, std::uint8_t{0}) != row + kWindow) return false;
  }
  return true;
}

bool is_smooth(const Window& truth) {
  constexpr std::uint32_t kBlock = 4;
  constexpr std::uint32_t kBlocks = kWindow / kBlock;
  std::array<double, std::size_t{kBlocks} * kBlocks> means{};
  const Window rest = without_plane(truth);
  for (std::uint32_t i = 0; i < kBins; ++i)
    means[i / kWindow / kBlock * kBlocks + i % kWindow / kBlock] += rest[i] / (kBlock * kBlock);
  const double squares = std::inner_product(means.begin(), means.end(), means.begin(), 0.0);
  return std::sqrt(squares / means.size()) <= kSmooth;
}

using Spectrum = std::array<std::complex<double>, kBins>;

// Returns the Fourier transforms of the columns, as rows.
Spectrum transformed_columns(const Spectrum& values) {
  static const auto kWaves = [] {
    std::array<std::complex<double>, kWindow> waves;
    for (std::uint32_t i = 0; i < kWindow; ++i)
      waves[i] = std::polar(1.0 / kWindow, -2.0 * kPi * i / kWindow);
    return waves;
  }();
  Spectrum transforms{};
  for (std::uint32_t i = 0; i < kBins; ++i)
    for (std::uint32_t u = 0; u < kWindow; ++u)
      transforms[i % kWindow * kWindow + u] += values[i] * kWaves[u * (i / kWindow) % kWindow];
  return transforms;
}

// The power at each frequency: element v * 32 + u is the part of the variance of `values` that
// waves of u/32 cycles per pixel in x and v/32 in y have. Frequencies from 16/32 on stand for
// negative ones. A Hann window keeps what is not periodic in the window from leaking into all
// frequencies; it spreads a wave over 3x3 of them.
std::vector<double> power_spectrum(const Window& values) {
  // The factor keeps the variance of white noise.
  const auto hann = [](std::uint32_t i) {
    return std::sqrt(2.0 / 3.0) * (1.0 - std::cos(2.0 * kPi * (i + 0.5) / kWindow));
  };
  Spectrum weighted;
  for (std::uint32_t i = 0; i < kBins; ++i)
    weighted[i] = values[i] * hann(i % kWindow) * hann(i / kWindow);
  const Spectrum spectrum = transformed_columns(transformed_columns(weighted));
  std::vector<double> powers(kBins);
  std::ranges::transform(spectrum, powers.begin(), [](auto wave) { return std::norm(wave); });
  return powers;
}

// Cycles per pixel of a frequency.
double cycles_per_pixel(std::size_t bin) {
  const auto signed_cycles = [](std::size_t i) {
    return (static_cast<double>(i) - (i >= kWindow / 2 ? kWindow : 0)) / kWindow;
  };
  return std::hypot(signed_cycles(bin % kWindow), signed_cycles(bin / kWindow));
}

// All frequencies in the order of their length, without the lowest ones: the plane that was
// subtracted contained those.
const std::vector<std::size_t>& sorted_frequencies() {
  static const std::vector<std::size_t> sorted = [] {
    std::vector<std::size_t> all(kBins);
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::erase_if(all, [](std::size_t bin) { return cycles_per_pixel(bin) * kWindow < 1.5; });
    std::stable_sort(all.begin(), all.end(), [](std::size_t a, std::size_t b) {
      return cycles_per_pixel(a) < cycles_per_pixel(b);
    });
    return all;
  }();
  return sorted;
}

// The lower quartile, 0 for no values.
double lower_quartile(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto quartile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), quartile, values.end());
  return *quartile;
}

// Returns the strongest frequency among a frequency and its eight neighbours, if it is a peak of
// the spectrum, and otherwise the lowest frequency, 0. The edges of geometry have no peak: they
// spread their power over a line, and thus to frequencies on both sides. A wave has hardly any
// power at a distance of two frequencies.
std::size_t peak_near(const std::vector<double>& powers, std::size_t bin) {
  constexpr double kPeak = 4.0;
  const auto neighbour = [](std::size_t of, std::uint32_t right, std::uint32_t down) {
    return (of / kWindow + down) % kWindow * kWindow + (of + right) % kWindow;
  };
  std::size_t peak = bin;
  for (const std::uint32_t down : {0u, 1u, kWindow - 1}) {
    for (const std::uint32_t right : {0u, 1u, kWindow - 1}) {
      const std::size_t other = neighbour(bin, right, down);
      peak = powers[other] > powers[peak] ? other : peak;
    }
  }
  const auto on_line = [&](std::uint32_t right, std::uint32_t down) {
    return std::min(powers[neighbour(peak, right, down)],
                    powers[neighbour(peak, kWindow - right, kWindow - down)]);
  };
  const double line =
      std::max({on_line(2, 0), on_line(0, 2), on_line(2, 2), on_line(2, kWindow - 2)});
  return powers[peak] > kPeak * line ? peak : 0;
}

struct Pattern {
  double variance = 0;
  double period = 0;  // of its strongest wave, pixels; 0 if there is none
};

// The pattern in the mean of the spectra of `windows` windows, whose sum is `sums`.
Pattern find_pattern(const std::vector<double>& sums, double windows) {
  const std::vector<std::size_t>& frequencies = sorted_frequencies();
  std::vector<double> powers(frequencies.size());
  std::transform(frequencies.begin(), frequencies.end(), powers.begin(),
                 [&](std::size_t bin) { return sums[bin] / windows; });
  // The power of noise in such a mean has a gamma distribution of the order `windows`. The noise is
  // estimated by the lower quartile of the power at similar frequencies, because a pattern with
  // many harmonics stands out at more than half of them. By the formula of Wilson and Hilferty the
  // quartile is this part of the mean:
  const double quartile = std::pow(1.0 - 1.0 / (9.0 * windows) - 0.2248 / std::sqrt(windows), 3.0);
  // Powers over this multiple of the noise stand out. Of 100 windows of noise about one has such a
  // frequency.
  const double limit = 1.5 + 10.5 / std::sqrt(windows);
  Pattern pattern;
  double strongest = 0;
  const auto at = [&](std::size_t i) {
    return powers.begin() + static_cast<std::ptrdiff_t>(std::min(i, powers.size()));
  };
  for (std::size_t i = 0; i < powers.size(); ++i) {
    // The larger of both sides, because the spectrum of filtered noise falls towards high
    // frequencies.
    const double noise = std::max(lower_quartile({at(i - std::min(i, kSimilar)), at(i)}),
                                  lower_quartile({at(i + 1), at(i + 1 + kSimilar)})) /
                         quartile;
    if (powers[i] <= limit * noise) continue;
    const double cycles = cycles_per_pixel(peak_near(sums, frequencies[i]));
    if (cycles * kLongestPeriod < 1.0) continue;
    pattern.variance += powers[i] - noise;
    if (powers[i] > strongest) {
      strongest = powers[i];
      pattern.period = 1.0 / cycles;
    }
  }
  return pattern;
}

}  // namespace

double Weave::rms() const {
  return windows > 0 ? std::sqrt(find_pattern(powers, static_cast<double>(windows)).variance) : 0.0;
}

double Weave::period() const {
  return windows > 0 ? find_pattern(powers, static_cast<double>(windows)).period : 0.0;
}

double Weave::visible_fraction() const {
  return windows > 0 ? static_cast<double>(visible_windows) / static_cast<double>(windows) : 0.0;
}

double Weave::grain() const {
  double variance = 0.0;
  for (std::size_t bin = 0; bin < powers.size(); ++bin) {
    const double cycles = cycles_per_pixel(bin);
    const bool in_band = cycles * kShortestGrain <= 1.0 && cycles * kLongestGrain >= 1.0;
    variance += in_band ? powers[bin] / static_cast<double>(windows) : 0.0;
  }
  return std::sqrt(variance);
}

Weave& Weave::operator+=(const Weave& more) {
  windows += more.windows;
  visible_windows += more.visible_windows;
  powers.resize(std::max(powers.size(), more.powers.size()));
  std::transform(more.powers.begin(), more.powers.end(), powers.begin(), powers.begin(),
                 std::plus<>());
  return *this;
}

Weave measure_weave(const Image<float>& result, const Image<float>& truth, const Mask& surfaces) {
  Weave weave;
  for (std::uint32_t top = 0; top + kWindow <= truth.height; top += kStep) {
    for (std::uint32_t left = 0; left + kWindow <= truth.width; left += kStep) {
      if (!all_surfaces(surfaces, left, top)) continue;
      const Window true_values = read_window(truth, left, top);
      Window error = read_window(result, left, top);
      std::transform(error.begin(), error.end(), true_values.begin(), error.begin(),
                     std::minus<>());
      // The comparisons are false for NaN.
      if (!is_smooth(true_values) ||
          !std::isfinite(std::accumulate(error.begin(), error.end(), 0.0)))
        continue;
      std::vector<double> powers = power_spectrum(without_plane(error));
      const bool visible = find_pattern(powers, 1.0).variance > Weave::kVisible * Weave::kVisible;
      weave += {1, visible ? 1u : 0u, std::move(powers)};
    }
  }
  return weave;
}

std::string weave_line(const Weave& weave) {
  return fmt::format(
      "Weave (regular patterns with periods of 2 to {:.0f} pixels): RMS {:.4f}, strongest period "
      "{:.1f} pixels, over {} windows in which the truth is smooth; {:.1f} % of them exceed "
      "{:.3f}. Grain (periods of {:.0f} to {:.0f} pixels): RMS {:.4f}\n",
      kLongestPeriod, weave.rms(), weave.period(), weave.windows, 100.0 * weave.visible_fraction(),
      Weave::kVisible, kShortestGrain, kLongestGrain, weave.grain());
}

nlohmann::ordered_json to_json(const Weave& weave) {
  return {{"windows", weave.windows},
          {"rms", weave.rms()},
          {"period_px", weave.period()},
          {"visible_fraction", weave.visible_fraction()},
          {"grain_rms", weave.grain()}};
}

}  // namespace alcove::sample
