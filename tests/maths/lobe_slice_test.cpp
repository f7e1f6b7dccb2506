#include "maths/lobe_slice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "maths/raw_occlusion.h"
#include "maths/visibility_bitmask.h"
#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;
using maths::HalfLobe;
using maths::Slice;

constexpr float kRoughnesses[] = {0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f};

// The integral of the GGX lobe in a slice in double precision. It evaluates the definition with the
// half vector, and not the half-angle identity of the shaders.
class LobeTruth {
 public:
  LobeTruth(const Slice& s, double n_dot_v, double alpha)
      : slice_(s), n_dot_v_(n_dot_v), alpha_(alpha) {}

  double density(double t) const {
    const double n_dot_l = normal_along(t);
    if (n_dot_l <= 0.0) return 0.0;
    const double a2 = alpha_ * alpha_;
    return distribution(t) * std::abs(std::sin(t)) /
           (1.0 + lambda(n_dot_v_, a2) + lambda(n_dot_l, a2));
  }

  double distribution(double t) const {
    // The half vector of (0,1) and (sin t, cos t).
    const double x = std::sin(t), y = 1.0 + std::cos(t), length = std::hypot(x, y);
    const double n_dot_h = (slice_.along() * x + slice_.toward() * y) / length;
    const double a2 = alpha_ * alpha_, d = 1.0 - n_dot_h * n_dot_h * (1.0 - a2);
    return a2 / (kPi * d * d);
  }

  // Returns the integral of f between two angles, with more panels near the centre of the lobe.
  template <typename Function>
  double between(Function f, double from, double to) const {
    if (from >= to) return 0.0;
    const double centre = 2 * slice_.truth.gamma;
    std::vector<double> cuts = {from, to, 0.0};
    for (double width = 0.25 * alpha_; width < 4.0; width *= 2) {
      cuts.push_back(centre - width);
      cuts.push_back(centre + width);
    }
    for (double& cut : cuts) cut = std::clamp(cut, from, to);
    std::sort(cuts.begin(), cuts.end());
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
      if (cuts[k + 1] > cuts[k]) sum += integrate(f, cuts[k], cuts[k + 1], 8);
    return sum;
  }

  double integral(double from, double to) const {
    return between([this](double t) { return density(t); }, from, to);
  }

  double lowest() const { return slice_.truth.lowest(); }
  double highest() const { return slice_.truth.highest(); }

 private:
  struct Components {
    explicit Components(const Slice& s) : truth(s) {}
    double along() const { return truth.scale * std::sin(truth.gamma); }
    double toward() const { return truth.scale * std::cos(truth.gamma); }
    SliceTruth truth;
  };

  double normal_along(double t) const {
    return slice_.along() * std::sin(t) + slice_.toward() * std::cos(t);
  }
  static double lambda(double c, double a2) {
    return 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0);
  }

  Components slice_;
  double n_dot_v_, alpha_;
};

// A surface tilted against the view direction. slice() returns its slice at an angle around the
// view direction.
struct Surface {
  vec3 view{0, 0, 1};
  vec3 normal;
  maths::ViewBasis basis = maths::make_view_basis(view);

  explicit Surface(double tilt) : normal(float(std::sin(tilt)), 0, float(std::cos(tilt))) {}
  Slice slice(double phi) const {
    return maths::make_slice(normal, maths::slice_direction(basis, float(phi)), view);
  }
};

TEST(LobeSlice, AntiderivativeOfTheLobeMatchesQuadratureOfTheGgxDistribution) {
  RandomInput random;
  double worst = 0.0;
  for (const float roughness : kRoughnesses) {
    const float alpha = roughness * roughness;
    for (int i = 0; i < 300; ++i) {
      const Slice s = Surface(random.uniform(0.0f, 1.5f)).slice(random.uniform(0.0f, 3.14f));
      const LobeTruth truth(s, s.toward, alpha);
      const float side = random.bits() % 2 == 0 ? 1.0f : -1.0f;
      const HalfLobe lobe = maths::make_half_lobe(s, side, alpha);
      const double end = side > 0 ? truth.highest() : truth.lowest();
      const double angle = end * random.uniform(0.0f, 1.0f);
      const auto d = [&](double t) { return truth.distribution(t) * std::abs(std::sin(t)); };
      const double expected = truth.between(d, std::min(angle, 0.0), std::max(angle, 0.0));
      const double whole = truth.between(d, truth.lowest(), truth.highest());
      glm::vec2 light = maths::horizon_light(s, side, float(std::cos(angle)));
      light.x *= side;
      const float part = std::abs(maths::lobe_antiderivative(lobe.density, light) - lobe.at_view);
      worst = std::max(worst, std::abs(part - expected) / std::max(whole, 1e-3));
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 5e-3);
}

// The lobe in both half-slices of a slice.
struct WholeLobe {
  Slice slice;
  HalfLobe ahead, behind;
  float open;

  WholeLobe(const Slice& s, float alpha)
      : slice(s),
        ahead(maths::make_half_lobe(s, 1.0f, alpha)),
        behind(maths::make_half_lobe(s, -1.0f, alpha)),
        open(ahead.whole + behind.whole) {}

  // Returns the integral between the two horizons, which are given by their cosines.
  float between(float horizon_ahead, float horizon_behind) const {
    return lobe_arc(slice, ahead, horizon_ahead) + lobe_arc(slice, behind, horizon_behind);
  }
};

struct Error {
  double squares = 0.0, worst = 0.0;
  int count = 0;
  void add(double error) {
    squares += error * error;
    worst = std::max(worst, std::abs(error));
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

Error horizon_error(RandomInput& random, int slices, float roughness, int cases) {
  const float alpha = roughness * roughness;
  Error error;
  for (int i = 0; i < cases; ++i) {
    const double tilt = std::acos(random.uniform(0.05f, 1.0f));
    const Surface surface(tilt);
    double visible = 0.0, open = 0.0;
    float visible_sum = 0.0f, open_sum = 0.0f;
    for (int k = 0; k < slices; ++k) {
      const Slice s = surface.slice(slices == 1 ? 0.0 : kPi * (k + 0.5) / slices);
      const LobeTruth truth(s, std::cos(tilt), alpha);
      const double ahead = std::clamp(truth.highest() * random.uniform(0.0f, 1.3f), 0.0, kPi);
      const double behind = std::clamp(truth.lowest() * random.uniform(0.0f, 1.3f), -kPi, 0.0);
      visible += truth.integral(std::max(behind, truth.lowest()), std::min(ahead, truth.highest()));
      open += truth.integral(truth.lowest(), truth.highest());
      const WholeLobe lobe(s, alpha);
      visible_sum += lobe.between(float(std::cos(ahead)), float(std::cos(behind)));
      open_sum += lobe.open;
    }
    error.add(maths::mean_visibility({visible_sum, open_sum}) - visible / open);
  }
  return error;
}

void expect_horizon_error_below(double rms, double worst, int slices, int cases) {
  RandomInput random;
  for (const float roughness : kRoughnesses) {
    const Error error = horizon_error(random, slices, roughness, cases);
    std::cout << "slices: " << slices << ", roughness: " << roughness << ", RMS error of the lobe "
              << error.rms() << ", at most " << error.worst << "\n";
    EXPECT_LT(error.rms(), rms) << "roughness " << roughness;
    EXPECT_LT(error.worst, worst) << "roughness " << roughness;
  }
}

TEST(LobeSlice, LobeVisibilityOfOneSliceStaysWithinItsStatedErrorOfTheFullBrdf) {
  expect_horizon_error_below(0.011, 0.07, 1, 4000);
}

TEST(LobeSlice, LobeVisibilityOfSixteenSlicesStaysWithinItsStatedErrorOfTheFullBrdf) {
  expect_horizon_error_below(0.007, 0.05, 16, 200);
}

TEST(LobeSlice, UnoccludedSlicesOfAllOrientationsSumToTheLobeOfTheBrdf) {
  for (const float roughness : {0.3f, 0.6f, 1.0f}) {
    for (const double tilt : {0.2, 0.8, 1.3}) {
      const Surface surface(tilt);
      const float alpha = roughness * roughness;
      const double in_slices =
          integrate([&](double phi) { return double(WholeLobe(surface.slice(phi), alpha).open); },
                    0.0, kPi, 64);
      const double whole = integrate(
          [&](double phi) {
            const LobeTruth truth(surface.slice(phi), std::cos(tilt), alpha);
            return truth.integral(truth.lowest(), truth.highest());
          },
          0.0, kPi, 64);
      EXPECT_NEAR(in_slices / whole, 1.0, 0.1) << roughness << " " << tilt;
    }
  }
}

TEST(LobeSlice, LobeVisibilityOfFullyOpenAndFullyOccludedSlicesIsExact) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Slice s = Surface(random.uniform(0.0f, 1.5707f)).slice(random.uniform(0.0f, 3.14f));
    const WholeLobe lobe(s, random.uniform(0.0f, 1.0f));
    EXPECT_TRUE(std::isfinite(lobe.open));
    EXPECT_GE(lobe.open, 0.0f);
    EXPECT_NEAR(lobe.between(-1.0f, -1.0f), lobe.open, 1e-6f * lobe.open);
    EXPECT_EQ(lobe.between(1.0f, 1.0f), 0.0f);
  }
}

TEST(LobeSlice, VisiblePartOfTheLobeIncreasesAsTheHorizonFalls) {
  RandomInput random;
  for (int i = 0; i < 300; ++i) {
    const Slice s = Surface(random.uniform(0.0f, 1.57f)).slice(random.uniform(0.0f, 3.14f));
    const WholeLobe lobe(s, random.uniform(0.0f, 1.0f));
    for (const float side : {-1.0f, 1.0f}) {
      float before = 0.0f;
      for (float c = 1.0f; c >= -1.0f; c -= 0.01f) {
        const float arc = lobe_arc(s, side > 0.0f ? lobe.ahead : lobe.behind, c);
        EXPECT_GE(arc, before - 1e-3f * lobe.open);
        before = arc;
      }
    }
  }
}

TEST(LobeSlice, MirrorReflectionIsVisibleIfTheHorizonIsBelowItsDirection) {
  const double tilt = 0.4;
  const Slice s = Surface(tilt).slice(0.0);
  const WholeLobe lobe(s, 0.0f);
  const auto visible_share = [&](double horizon) {
    return lobe.between(float(std::cos(horizon)), -1.0f) / lobe.open;
  };
  EXPECT_LT(visible_share(2 * tilt - 0.1), 0.02f);
  EXPECT_NEAR(visible_share(2 * tilt), 0.5f, 0.02f);
  EXPECT_GT(visible_share(2 * tilt + 0.1), 0.98f);
}

// The sectors beyond the horizon, rounded to the nearest boundary, are occluded.
TEST(LobeSlice, BitmaskOccludedBelowAHorizonLeavesTheLobeVisibleAboveThatHorizon) {
  RandomInput random;
  for (const float roughness : kRoughnesses) {
    Error error;
    for (int i = 0; i < 2000; ++i) {
      const Slice s = Surface(random.uniform(0.0f, 1.5f)).slice(random.uniform(0.0f, 3.14f));
      const WholeLobe lobe(s, roughness * roughness);
      const float side = random.bits() % 2 == 0 ? 1.0f : -1.0f;
      const HalfLobe& half = side > 0.0f ? lobe.ahead : lobe.behind;
      const float per_diamond_angle = 32.0f / maths::tangent_diamond_angle(s, side);
      const unsigned first = random.bits() % 32;
      const unsigned hidden = 0xffffffffu << first;
      const float cosine = maths::diamond_angle_light(float(first) / per_diamond_angle).y;
      for (const float hidden_occlusion : {0.0f, 0.4f, 1.0f}) {
        error.add((maths::visible_lobe(half, per_diamond_angle, hidden, hidden_occlusion) -
                   lobe_arc(s, half, cosine)) /
                  lobe.open);
      }
      // A run of occluded sectors, and visible ones behind it.
      const unsigned begin = random.bits() % 31, end = begin + 1 + random.bits() % (31 - begin);
      const auto arc = [&](unsigned sector) {
        return maths::lobe_light_arc(half,
                                     maths::diamond_angle_light(float(sector) / per_diamond_angle));
      };
      error.add((maths::visible_lobe(half, per_diamond_angle, (1u << end) - (1u << begin), 0.4f) -
                 arc(begin) - 0.6f * (half.whole - arc(end))) /
                lobe.open);
      EXPECT_FLOAT_EQ(maths::visible_lobe(half, per_diamond_angle, 0u, 0.4f), half.whole);
      EXPECT_LT(maths::visible_lobe(half, per_diamond_angle, ~0u, 0.4f), 2e-3f * lobe.open);
    }
    EXPECT_LT(error.worst, 2e-3) << "roughness " << roughness;
  }
}

TEST(LobeSlice, SliceThroughViewAndNormalContainsTheMirrorDirection) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    const maths::ViewBasis basis = maths::make_view_basis(view);
    const vec3 direction = maths::slice_direction(basis, maths::lobe_plane(normal, basis));
    const vec3 mirror = reflect(-view, normal);
    EXPECT_NEAR(dot(mirror, cross(view, direction)), 0.0f, 1e-4f);
    EXPECT_TRUE(std::isfinite(maths::lobe_plane(view, basis)));
  }
}

TEST(LobeSlice, WeightedSliceAnglesConcentratedOnTheLobeGiveTheSameMeanAsUniformAngles) {
  for (const float roughness : kRoughnesses) {
    double plain = 0.0, weighted = 0.0, weights = 0.0;
    const auto f = [](double phi) {
      return 1.0 + 0.5 * std::cos(2 * phi + 0.3) + std::sin(4 * phi);
    };
    constexpr int kTurns = 1000;
    for (int i = 0; i < kTurns; ++i) {
      const double phi = kPi * (i + 0.5) / kTurns;
      const maths::WeightedAngle angle = maths::lobe_angle(float(phi), 0.7f, roughness);
      EXPECT_GT(angle.weight, 0.15f);
      EXPECT_LT(angle.weight, 1.85f);
      plain += f(phi) / kTurns;
      weighted += angle.weight * f(angle.phi) / kTurns;
      weights += angle.weight / kTurns;
    }
    EXPECT_NEAR(weighted, plain, 1e-4);
    EXPECT_NEAR(weights, 1.0, 1e-5);
  }
  EXPECT_EQ(maths::lobe_angle(0.4f, 1.0f, 1.0f).weight, 1.0f);
}

}  // namespace
}  // namespace alcove::maths_test
