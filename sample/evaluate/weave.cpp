#include "evaluate/weave.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kWindow = 32;
constexpr std::uint32_t kPeriod = 4;
constexpr std::size_t kClasses = std::size_t{kPeriod} * kPeriod;
constexpr std::uint32_t kMeanRadius = 4;  // radius of the 9x9 mean
// The truth of a window is smooth if the means of its 4x4 blocks, less a plane fitted to them, have
// at most this RMS. Contact shadows and silhouettes have more; the noise of 256 rays per pixel has
// a quarter of it.
constexpr double kSmooth = 0.02;

// Sums over rectangles in constant time (a summed-area table).
class RectangleSums {
 public:
  explicit RectangleSums(const Image<double>& image)
      : width_(image.width + 1), sums_(std::size_t{width_} * (image.height + 1), 0.0) {
    for (std::uint32_t y = 0; y < image.height; ++y) {
      double row = 0;
      for (std::uint32_t x = 0; x < image.width; ++x) {
        row += image.at(x, y);
        sums_[std::size_t{y + 1} * width_ + x + 1] = sums_[std::size_t{y} * width_ + x + 1] + row;
      }
    }
  }
  // The sum over x0 <= x < x1, y0 <= y < y1.
  double operator()(std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1) const {
    const auto at = [this](std::uint32_t x, std::uint32_t y) {
      return sums_[std::size_t{y} * width_ + x];
    };
    return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
  }

 private:
  std::uint32_t width_;
  std::vector<double> sums_;
};

// The error at surfaces, less its mean over the surface pixels in the surrounding 9x9.
Image<double> high_pass(const Image<float>& result, const Image<float>& truth,
                        const Mask& surfaces) {
  Image<double> error(truth.width, truth.height);
  Image<double> counts(truth.width, truth.height);
  for (std::size_t i = 0; i < error.pixels.size(); ++i) {
    const double difference = double{result.pixels[i]} - truth.pixels[i];
    if (surfaces.pixels[i] != 0 && std::isfinite(difference)) {
      error.pixels[i] = difference;
      counts.pixels[i] = 1;
    }
  }
  const RectangleSums errors(error);
  const RectangleSums surface_counts(counts);
  for (std::uint32_t y = 0; y < error.height; ++y) {
    for (std::uint32_t x = 0; x < error.width; ++x) {
      const std::uint32_t x0 = x - std::min(x, kMeanRadius);
      const std::uint32_t y0 = y - std::min(y, kMeanRadius);
      const std::uint32_t x1 = std::min(x + kMeanRadius + 1, error.width);
      const std::uint32_t y1 = std::min(y + kMeanRadius + 1, error.height);
      if (const double count = surface_counts(x0, y0, x1, y1); count > 0) {
        error.at(x, y) -= errors(x0, y0, x1, y1) / count;
      }
    }
  }
  return error;
}

bool all_surfaces(const Mask& surfaces, std::uint32_t left, std::uint32_t top) {
  for (std::uint32_t y = top; y < top + kWindow; ++y) {
    const auto* row = &surfaces.at(left, y);
    if (std::find(row, row + kWindow, std::uint8_t{0}) != row + kWindow) {
      return false;
    }
  }
  return true;
}

bool is_smooth(const Image<float>& truth, std::uint32_t left, std::uint32_t top) {
  constexpr std::uint32_t kBlocks = kWindow / kPeriod;
  std::array<std::array<double, kBlocks>, kBlocks> means{};
  double mean = 0;
  double slope_x = 0;
  double slope_y = 0;
  double squared_places = 0;
  const auto place = [](std::uint32_t block) { return block - 0.5 * (kBlocks - 1); };
  for (std::uint32_t y = 0; y < kWindow; ++y) {
    for (std::uint32_t x = 0; x < kWindow; ++x) {
      means[y / kPeriod][x / kPeriod] += truth.at(left + x, top + y) / double{kClasses};
    }
  }
  for (std::uint32_t y = 0; y < kBlocks; ++y) {
    for (std::uint32_t x = 0; x < kBlocks; ++x) {
      mean += means[y][x] / (kBlocks * kBlocks);
      slope_x += means[y][x] * place(x);
      slope_y += means[y][x] * place(y);
      squared_places += place(x) * place(x);
    }
  }
  double squares = 0;
  for (std::uint32_t y = 0; y < kBlocks; ++y) {
    for (std::uint32_t x = 0; x < kBlocks; ++x) {
      const double plane = mean + (slope_x * place(x) + slope_y * place(y)) / squared_places;
      squares += (means[y][x] - plane) * (means[y][x] - plane);
    }
  }
  return std::sqrt(squares / (kBlocks * kBlocks)) <= kSmooth;
}

// The variance of the pattern in a window, less that of white noise. It may be negative by chance.
double pattern_variance(const Image<double>& error, std::uint32_t left, std::uint32_t top) {
  constexpr double kPixels = kWindow * kWindow;
  constexpr double kPixelsOfClass = kPixels / kClasses;
  std::array<double, kClasses> means{};
  double mean = 0;
  double squares = 0;
  for (std::uint32_t y = 0; y < kWindow; ++y) {
    for (std::uint32_t x = 0; x < kWindow; ++x) {
      const double value = error.at(left + x, top + y);
      means[std::size_t{y % kPeriod} * kPeriod + x % kPeriod] += value / kPixelsOfClass;
      mean += value / kPixels;
      squares += value * value;
    }
  }
  double between = 0;
  double explained = 0;
  for (const double of_class : means) {
    between += (of_class - mean) * (of_class - mean);
    explained += kPixelsOfClass * of_class * of_class;
  }
  const double noise = (squares - explained) / (kPixels - kClasses);
  return between / (kClasses - 1) - noise / kPixelsOfClass;
}

}  // namespace

double Weave::rms() const {
  return windows > 0 ? std::sqrt(std::max(variances, 0.0) / static_cast<double>(windows)) : 0.0;
}

double Weave::visible_fraction() const {
  return windows > 0 ? static_cast<double>(visible_windows) / static_cast<double>(windows) : 0.0;
}

Weave& Weave::operator+=(const Weave& more) {
  windows += more.windows;
  visible_windows += more.visible_windows;
  variances += more.variances;
  return *this;
}

Weave weave_of(const Image<float>& result, const Image<float>& truth, const Mask& surfaces) {
  const Image<double> error = high_pass(result, truth, surfaces);
  Weave weave;
  for (std::uint32_t top = 0; top + kWindow <= truth.height; top += kWindow) {
    for (std::uint32_t left = 0; left + kWindow <= truth.width; left += kWindow) {
      if (!all_surfaces(surfaces, left, top) || !is_smooth(truth, left, top)) {
        continue;
      }
      const double variance = pattern_variance(error, left, top);
      weave += {1, variance > Weave::kVisible * Weave::kVisible ? 1u : 0u, variance};
    }
  }
  return weave;
}

std::string weave_line(const Weave& weave) {
  return fmt::format(
      "Pattern that repeats every 4 pixels: RMS {:.4f} over {} windows in which the truth is "
      "smooth; {:.1f} % of them exceed {:.3f}\n",
      weave.rms(), weave.windows, 100.0 * weave.visible_fraction(), Weave::kVisible);
}

nlohmann::ordered_json to_json(const Weave& weave) {
  return {{"windows", weave.windows},
          {"rms", weave.rms()},
          {"visible_fraction", weave.visible_fraction()}};
}

}  // namespace alcove::sample
