#include "maths/gtao.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "maths/raw_occlusion.h"
#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;
using maths::Slice;

TEST(ArcCosine, ApproximationStaysWithinItsStatedErrorEverywhere) {
  double worst = 0.0;
  for (int i = -2000000; i <= 2000000; ++i) {
    const float x = float(i) / 2000000.0f;
    worst = std::max(worst, std::abs(double(maths::arc_cosine(x)) - std::acos(double(x))));
  }
  EXPECT_LT(worst, 4.6e-5);
}

TEST(ArcCosine, ArgumentIsClampedToMinusOneToOne) {
  EXPECT_EQ(maths::arc_cosine(1.0f), 0.0f);
  EXPECT_EQ(maths::arc_cosine(7.0f), 0.0f);
  EXPECT_FLOAT_EQ(maths::arc_cosine(-7.0f), float(kPi));
}

TEST(ViewBasis, BasisIsOrthonormalForEveryViewDirection) {
  RandomInput random;
  for (int i = 0; i < 10000; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1));
    const maths::ViewBasis basis = maths::make_view_basis(view);
    EXPECT_NEAR(dot(basis.x, basis.y), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(basis.x, view), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(basis.y, view), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(basis.x, basis.x), 1.0f, 1e-6f);
    EXPECT_NEAR(dot(cross(basis.x, basis.y), view), 1.0f, 1e-5f);
  }
}

TEST(Slice, AngleGammaIsTheSignedAngleFromTheViewDirectionToTheProjectedNormal) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2; gamma += 0.01)
    EXPECT_NEAR(maths::slice_gamma(slice_of(0.7, gamma)), gamma, 4.8e-5);
}

TEST(Slice, NormalPerpendicularToTheSlicePlaneGivesWeightAndVisibilityZero) {
  const Slice s = maths::make_slice(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1));
  EXPECT_EQ(s.scale, 0.0f);
  EXPECT_EQ(s.cosine, 1.0f);
  EXPECT_EQ(maths::open_slice(s), 0.0f);
  EXPECT_EQ(slice_visibility(s, -1.0f, -1.0f), 0.0f);
}

TEST(Slice, ZeroAndDenormalisedNormalsGiveFiniteResults) {
  for (const float size : {0.0f, 1e-42f, 1e-20f}) {
    const Slice s = maths::make_slice(vec3(size, 0, size), vec3(1, 0, 0), vec3(0, 0, 1));
    EXPECT_TRUE(std::isfinite(maths::open_slice(s)));
    EXPECT_TRUE(std::isfinite(slice_visibility(s, 0.3f, 0.3f)));
  }
}

TEST(Slice, NormalsFacingAwayFromTheEyeAreFlippedOrMadePerpendicularToTheView) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 view = random.unit_vector(), normal = random.unit_vector();
    const vec3 facing = maths::facing_normal(normal, view);
    EXPECT_NEAR(length(facing), 1.0f, 1e-5f);
    EXPECT_GE(dot(facing, view), -2e-3f);
    if (dot(normal, view) > 0.0f) {
      EXPECT_LT(distance(facing, normal), 1e-5f);
    } else if (dot(normal, view) < -maths::kFlippedNormal) {
      EXPECT_LT(distance(facing, -normal), 1e-5f);
    } else {
      EXPECT_NEAR(dot(facing, view), 0.0f, 2e-3f);
      EXPECT_GT(dot(facing, normal), 0.95f);
    }
  }
  EXPECT_EQ(maths::facing_normal(vec3(0, 0, -1), vec3(0, 0, 1)), vec3(0, 0, 1));
}

TEST(Gtao, VisibilityOfAHalfSliceAgreesWithQuadratureForEveryNormalAndHorizon) {
  double worst = 0.0;
  for_each_slice_and_horizon([&](const Slice& s, const SliceTruth& truth, float c) {
    const double ahead = truth.visibility(0.0, std::acos(double(c)));
    const double behind = truth.visibility(-std::acos(double(c)), 0.0);
    worst = std::max(worst, std::abs(slice_arc(s, 1.0f, c) - ahead));
    worst = std::max(worst, std::abs(slice_arc(s, -1.0f, c) - behind));
  });
  EXPECT_LT(worst, 2.4e-5);
}

TEST(Gtao, VisibilityOfAHalfSliceEqualsTheIntegralOfThePaper) {
  RandomInput random;
  for (int i = 0; i < 10000; ++i) {
    const double g = random.uniform(-1.57f, 1.57f), h = random.uniform(0.0f, float(g + kPi / 2));
    const double j = 0.25 * (-std::cos(2 * h - g) + std::cos(g) + 2 * h * std::sin(g));
    EXPECT_NEAR(slice_arc(slice_of(1.0, g), 1.0f, float(std::cos(h))), j, 5e-5);
  }
}

TEST(Gtao, VisibilityOfAHalfSliceIncreasesAsTheHorizonFallsToTheTangentPlane) {
  for (double gamma = -1.5; gamma <= 1.5; gamma += 0.1) {
    const Slice s = slice_of(1.0, gamma);
    float before = -1e-6f;
    for (float c = 1.0f; c >= -1.0f; c -= 1e-3f) {
      const float arc = slice_arc(s, 1.0f, c);
      EXPECT_GE(arc, before - 2e-5f) << "gamma " << gamma << " cosine " << c;
      before = arc;
    }
    EXPECT_EQ(slice_arc(s, 1.0f, -1.0f), slice_arc(s, 1.0f, maths::tangent_horizon(s, 1.0f)));
  }
}

TEST(Gtao, HorizonCosinesOutOfRangeAreClamped) {
  const Slice s = slice_of(1.0, 0.3);
  EXPECT_EQ(slice_visibility(s, 9.0f, 9.0f), 0.0f);
  EXPECT_EQ(slice_visibility(s, -9.0f, -9.0f), slice_visibility(s, -1.0f, -1.0f));
}

TEST(Gtao, VisibilityOfAnUnoccludedSliceEqualsTheIntegralUpToTheTangentPlane) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2; gamma += 0.01) {
    const Slice s = slice_of(0.8, gamma);
    EXPECT_NEAR(maths::open_slice(s), SliceTruth(s).open(), 5e-5);
    EXPECT_NEAR(slice_visibility(s, -1.0f, -1.0f), maths::open_slice(s), 1e-4);
    EXPECT_LE(slice_visibility(s, -1.0f, -1.0f), 1.5709f);
  }
}

// Returns the mean visibility over `slices` slices around `view`, computed as in the pass `gtao`.
// `horizon` returns the cosine of the horizon in each direction.
template <typename Horizon>
float visibility_over_slices(vec3 normal, vec3 view, int slices, double offset, Horizon horizon) {
  const maths::ViewBasis basis = maths::make_view_basis(view);
  float sum = 0.0f, weight = 0.0f;
  for (int k = 0; k < slices; ++k) {
    const vec3 direction = maths::slice_direction(basis, float(kPi * (k + offset) / slices));
    const Slice s = maths::make_slice(normal, direction, view);
    sum += slice_visibility(s, horizon(direction), horizon(-direction));
    weight += maths::open_slice(s);
  }
  return maths::mean_visibility({sum, weight});
}

TEST(Gtao, WeightsOfManySlicesOfAnyTiltedSurfaceAverageToOne) {
  const vec3 view(0, 0, 1);
  for (double tilt = 0.0; tilt < 1.57; tilt += 0.1) {
    const vec3 normal(float(std::sin(tilt)), 0, float(std::cos(tilt)));
    const maths::ViewBasis basis = maths::make_view_basis(view);
    double sum = 0.0;
    constexpr int kSlices = 4096;
    for (int k = 0; k < kSlices; ++k)
      sum += maths::open_slice(maths::make_slice(
          normal, maths::slice_direction(basis, float(kPi * (k + 0.5) / kSlices)), view));
    EXPECT_NEAR(sum / kSlices, 1.0, 1e-4);
  }
}

// Returns the elevation angle above a plane of the highest point of a sphere, as seen in a slice
// with the given direction. The sphere has radius 1 and rests on the plane at distance x from the
// shaded point. Returns 0 if the slice misses the sphere.
double sphere_elevation(double x, glm::dvec2 direction) {
  const double across = x * direction.y, toward = x * direction.x;
  if (toward <= 0.0 || std::abs(across) >= 1.0) return 0.0;
  const double radius = std::sqrt(1.0 - across * across);
  return std::atan2(1.0, toward) + std::asin(radius / std::hypot(toward, 1.0));
}

TEST(Gtao, SphereOnAPlaneOccludesEverythingBelowItsUpperSilhouette) {
  const vec3 up(0, 0, 1);
  for (double x : {1.2, 1.5, 2.0, 3.0, 6.0}) {
    const auto open_sector = [x](double phi) {
      const double zenith =
          kPi / 2 - std::min(sphere_elevation(x, {std::cos(phi), std::sin(phi)}), kPi / 2);
      return 0.5 * std::sin(zenith) * std::sin(zenith);
    };
    const double expected = integrate(open_sector, 0.0, 2 * kPi, 4000) / kPi;
    // A sphere with open space below it would occlude less: sin^2 of its half-angle times the
    // cosine of the angle between its centre and the normal.
    EXPECT_LT(expected, 1.0 - 1.0 / std::pow(x * x + 1.0, 1.5));
    const float a = visibility_over_slices(up, up, 4096, 0.5, [x](vec3 direction) {
      const double elevation = sphere_elevation(x, {direction.x, direction.y});
      return float(std::sin(std::min(elevation, kPi / 2)));
    });
    EXPECT_NEAR(a, expected, 3e-4) << "x " << x;
  }
}

TEST(Gtao, BottomOfAGrooveHasVisibilityOfTheSineOfItsHalfAngle) {
  // From the bottom of an infinite groove the open sky is a wedge, whose view factor is the sine of
  // its half-angle.
  const vec3 up(0, 0, 1);
  for (double half : {0.2, 0.5, 1.0, 1.4}) {
    const float a = visibility_over_slices(up, up, 2048, 0.5, [&](vec3 direction) {
      // In a slice that is not perpendicular to the groove, the wall rises less steeply.
      const double slope = std::abs(double(direction.x)) / std::tan(half);
      return float(slope / std::hypot(1.0, slope));
    });
    EXPECT_NEAR(a, std::sin(half), 2e-4) << "half angle " << half;
  }
}

// Two planes through a point leave a lune of the sphere visible.
TEST(Gtao, UniformVisibilityAgreesWithQuadratureAndWithTheSolidAngleBetweenTwoPlanes) {
  for (double h = 0.0; h <= kPi; h += kPi / 90) {
    const double expected = 0.5 * integrate([](double t) { return std::sin(t); }, 0.0, h);
    EXPECT_NEAR(maths::uniform_arc({float(std::sin(h)), float(std::cos(h))}), expected, 1e-6);
  }
  RandomInput random;
  for (int i = 0; i < 200; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1));
    const vec3 normal = random.facing(view), other = random.facing(view);
    constexpr int kSlices = 2048;
    float sum = 0.0f;
    for (int k = 0; k < 2 * kSlices; ++k) {
      const vec3 direction =
          maths::slice_direction(maths::make_view_basis(view), float(kPi * (k + 0.5) / kSlices));
      const Slice s = maths::make_slice(normal, direction, view);
      const Slice o = maths::make_slice(other, direction, view);
      sum += maths::uniform_arc(maths::horizon_light(s, 1.0f, maths::tangent_horizon(o, 1.0f)));
    }
    EXPECT_NEAR(sum / kSlices, 1.0 - std::acos(dot(normal, other)) / kPi, 1e-3);
  }
}

TEST(Gtao, VisibilityIsBetweenZeroAndOneForAnyHorizons) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    const float a = visibility_over_slices(normal, view, 1, random.uniform(0, 1),
                                           [&](vec3) { return random.uniform(-1.2f, 1.2f); });
    EXPECT_GE(a, 0.0f);
    EXPECT_LE(a, 1.0f);
  }
}

}  // namespace
}  // namespace alcove::maths_test
