#include "maths/unobserved.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using maths::Slice;
using maths::Unobserved;
using maths::UnobservedArc;

constexpr float kRadiusPx = 40.0f;

// A random half-slice with directions that the depth buffer does not show.
struct Case {
  Slice slice;
  float side;
  float per_diamond_angle;
  std::uint32_t occluded;
  Unobserved unobserved;

  explicit Case(RandomInput& random)
      : slice(random_slice(random)),
        side(random.bits() % 2 == 0 ? 1.0f : -1.0f),
        per_diamond_angle(32.0f / maths::tangent_diamond_angle(slice, side)),
        occluded(random.bits() % 3 == 0 ? 0u : 0xffffffffu << random.bits() % 32),
        unobserved(maths::nothing_unobserved()) {
    const float first = random.uniform(0.0f, 1.2f) * kRadiusPx;
    const float width = random.uniform(0.0f, 0.3f) * kRadiusPx;
    if (const auto columns = float(random.bits() % 4); columns > 0.0f)
      unobserved = {first, columns * width, 1.0f};
  }

  UnobservedArc arc() const {
    return maths::make_unobserved_arc(first_light(), unobserved, kRadiusPx);
  }

  // Returns the excluded part of the half-slice.
  float excluded() const {
    return maths::unobserved_part(arc(), slice, side, maths::light_arc(slice, side, arc().to));
  }

  // Returns sine and cosine of the angle of the first occluded direction, or of the tangent plane.
  glm::vec2 first_light() const {
    return occluded == 0
               ? maths::tangent_light(slice, side)
               : maths::diamond_angle_light(float(std::countr_zero(occluded)) / per_diamond_angle);
  }

  double tangent() const { return std::acos(double(maths::tangent_horizon(slice, side))); }

  // Return the angles to the view direction at which the unobserved directions begin and end.
  double begins() const { return std::asin(std::min(1.0, double(unobserved.first) / kRadiusPx)); }
  double ends() const {
    if (occluded == 0) return tangent();
    const double y = 1.0 - std::countr_zero(occluded) / double(per_diamond_angle);
    return std::atan2(1.0 - std::abs(y), y);
  }
  double share() const {
    return std::min(std::sqrt(double(unobserved.width) / kRadiusPx),
                    double(maths::kMostUnobserved));
  }

  // Returns the excluded fraction of the integral of `density` over the directions of the
  // half-slice.
  template <typename Density>
  double truth(Density density) const {
    const double from = begins(), to = ends();
    return from < to ? share() * integrate(density, from, to) : 0.0;
  }
};

TEST(UnobservedDirections, ExcludedPartOfAHalfSliceEqualsQuadratureOfTheExcludedDirections) {
  constexpr int kCases = 20000;
  RandomInput random;
  double worst = 0.0, sum = 0.0, largest = 0.0;
  for (int i = 0; i < kCases; ++i) {
    const Case c(random);
    const SliceTruth slice(c.slice);
    const double part = c.excluded();
    const double truth = c.truth([&](double t) { return slice.density(double(c.side) * t); });
    worst = std::max(worst, std::abs(part - truth));
    sum += std::abs(part - truth);
    largest = std::max(largest, truth);
  }
  EXPECT_GT(largest, 0.5);
  // Rounding a cosine near 1 changes its angle by up to 3.5e-4. The weight of a direction is at
  // most 0.5, so that the error of the integral is below 2e-4.
  EXPECT_LT(worst, 2e-4);
  // Such small angles are rare. At other angles the error is that of light_arc(), which is at most
  // 2.4e-5.
  EXPECT_LT(sum / kCases, 3e-6);
}

TEST(UnobservedDirections, ExcludedPartOfTheSpecularLobeIsThatWithinTheUnobservedDirections) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Case c(random);
    const float alpha = random.uniform(0.01f, 1.0f);
    const maths::HalfLobe lobe = maths::make_half_lobe(c.slice, c.side, alpha);
    const float open = lobe.whole + maths::make_half_lobe(c.slice, -c.side, alpha).whole;
    const auto up_to = [&](double angle) {
      return double(lobe_arc(c.slice, lobe, float(std::cos(angle))));
    };
    const double from = std::min(c.begins(), c.ends());
    const double truth = c.share() * (up_to(c.ends()) - up_to(from));
    const float lobe_to = maths::lobe_light_arc(lobe, c.arc().to);
    EXPECT_NEAR(maths::unobserved_lobe(c.arc(), lobe, lobe_to), truth, 2e-3 * open + 1e-6);
  }
}

TEST(UnobservedDirections, NothingIsExcludedFromAHalfSliceWhoseDirectionsAreAllObserved) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    Case c(random);
    c.unobserved = maths::nothing_unobserved();
    EXPECT_EQ(c.excluded(), 0.0f);
    // Behind the first occluder, the setting `hidden_occlusion` applies instead.
    c = Case(random);
    c.occluded |= 1u;
    EXPECT_EQ(c.excluded(), 0.0f);
  }
}

TEST(UnobservedDirections, ManyShortRowsExcludeNoMoreDirectionsOfASliceThanOneRow) {
  const Unobserved leaves{.first = 4.0f, .width = 20.0f, .rows = 5.0f};
  EXPECT_EQ(maths::mean_row(leaves).width, 4.0f);
  EXPECT_EQ(maths::mean_row(leaves).first, 4.0f);
  EXPECT_EQ(maths::mean_row(maths::nothing_unobserved()).width, 0.0f);
}

TEST(UnobservedDirections, GivenFractionOfTheDirectionsBeyondTheImageBorderIsExcluded) {
  const Unobserved some{.first = 7.0f, .width = 2.0f, .rows = 1.0f};
  const Unobserved border = maths::add_beyond_border(some, 9.0f, 12.0f, 0.5f);
  EXPECT_EQ(border.first, 7.0f);
  EXPECT_EQ(border.width, 5.0f);
  EXPECT_EQ(maths::add_beyond_border(some, 3.0f, 12.0f, 0.5f).first, 3.0f);
  const Slice slice = maths::make_slice({0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f});
  const Unobserved all =
      maths::add_beyond_border(maths::nothing_unobserved(), 0.0f, kRadiusPx, 0.3f);
  const glm::vec2 tangent = maths::tangent_light(slice, 1.0f);
  EXPECT_NEAR(maths::make_unobserved_arc(tangent, all, kRadiusPx).share, 0.3f, 1e-6f);
}

TEST(UnobservedDirections,
     FractionExcludedBeyondTheBorderFallsNearTheEyeAndIfBothHalfSlicesLeaveTheImage) {
  EXPECT_EQ(maths::border_share(0.0f, 0.0f), 0.5f);
  EXPECT_EQ(maths::border_share(0.25f, 0.0f), 0.375f);
  EXPECT_EQ(maths::border_share(1.0f, 0.0f), 0.0f);
  EXPECT_EQ(maths::border_share(0.0f, 0.5f), 0.46875f);
  for (const float nearness : {1.0f, 2.0f, 1e30f})
    EXPECT_EQ(maths::border_share(0.0f, nearness), 0.0f);
}

TEST(UnobservedDirections, NothingIsExcludedIfTheRadiusLiesInsideTheImage) {
  const Unobserved none = maths::nothing_unobserved();
  EXPECT_EQ(maths::add_beyond_border(none, 9.0f, 0.0f, 1.0f).first, none.first);
  EXPECT_EQ(maths::add_beyond_border(none, maths::kNowhere, 10.0f, 1.0f).width, 0.0f);
}

TEST(UnobservedDirections, DirectionsOfAHalfSliceAreNeverAllExcluded) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    Case c(random);
    c.occluded = 0;
    c.unobserved = {.first = 0.0f, .width = 3.0f * kRadiusPx};
    const float whole = maths::light_arc(c.slice, c.side, maths::tangent_light(c.slice, c.side));
    EXPECT_LE(c.excluded(), maths::kMostUnobserved * whole + 1e-6f);
  }
}

}  // namespace
}  // namespace alcove::maths_test
