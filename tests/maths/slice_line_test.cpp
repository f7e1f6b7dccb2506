#include "maths/slice_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "maths/connected_samples.h"
#include "maths/projection.h"
#include "maths/slice.h"
#include "projection_truth.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec2;
using glm::vec3;
using maths::Projection;
using maths::SliceLine;

constexpr unsigned kWidth = 640, kHeight = 360;

Projection some_projection(RandomInput& random) {
  glm::mat4 m(0.0f);
  const vec2 shift{random.uniform(-0.3f, 0.3f), random.uniform(-0.3f, 0.3f)};
  m[0][0] = random.uniform(0.5f, 2.0f);
  m[1][1] = random.uniform(0.5f, 2.0f);
  if (random.bits() % 2 == 0) m[1][1] = -m[1][1];
  if (random.bits() % 2 == 0) {
    m[2] = glm::vec4(shift, -1.0f, -1.0f);
    m[3][2] = -0.1f;
  } else {
    m[2][2] = -0.01f;
    m[3] = glm::vec4(shift, 0.0f, 1.0f);
  }
  return maths::make_projection(m, kWidth, kHeight).value();
}

// A point of a surface, a slice through it, and the slice's line on the image.
struct Setting {
  Projection projection;
  vec2 pixel;
  float depth;
  vec3 position, view, normal, direction;
  SliceLine line;

  explicit Setting(RandomInput& random)
      : projection(some_projection(random)),
        pixel{random.uniform(0, kWidth), random.uniform(0, kHeight)},
        depth(random.uniform(1.0f, 20.0f)),
        position(position_at(projection, pixel, depth)),
        view(view_at(projection, pixel)),
        normal(maths::facing_normal(random.unit_vector(), view)),
        direction(maths::slice_direction(maths::make_view_basis(view), random.uniform(0, 6.28f))),
        line(maths::make_slice_line(projection.ray_per_px(), direction, view)) {}

  bool perspective() const { return projection.perspective; }

  vec3 delta(vec2 offset_px, float sample_depth) const {
    return position_at(projection, pixel + offset_px, sample_depth) - position;
  }

  vec2 point(float offset_px, float sample_depth) const {
    const float sample_line = perspective() ? 1.0f / sample_depth : sample_depth;
    const float rise = perspective() ? depth * sample_line - 1.0f : depth - sample_line;
    return vec2(offset_px * line.x_per_step,
                offset_px * line.y_per_step + rise * line.y_per_depth) /
           (perspective() ? sample_line : 1.0f);
  }
};

TEST(SliceLine, SampleOnTheImageLineOfASliceGetsTheSliceCoordinatesOfItsSurfacePoint) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    const float offset = random.uniform(-60.0f, 60.0f);
    const float depth = s.depth * random.uniform(0.5f, 2.0f);
    const vec3 delta = s.delta(s.line.direction_px * offset, depth);
    ASSERT_NEAR(dot(delta, cross(s.view, s.direction)), 0.0f, 1e-4f * s.depth)
        << "the point must lie in the plane of the slice";
    const vec2 point = s.point(offset, depth);
    EXPECT_NEAR(point.x, dot(delta, s.direction), 3e-4f * s.depth);
    EXPECT_NEAR(point.y, dot(delta, s.view), 3e-4f * s.depth);
  }
}

float inverse_depth_of(float depth, bool perspective) { return perspective ? 1.0f / depth : depth; }

TEST(SliceLine, BackFaceDepthEndsAnOccluderOnlyIfItIsBehindTheFrontFace) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const bool perspective = random.bits() % 2 == 0;
    const float depth = random.uniform(0.1f, 1000.0f);
    const float front = inverse_depth_of(depth, perspective);
    const float behind = inverse_depth_of(depth * random.uniform(1.001f, 1e4f), perspective);
    const float before = inverse_depth_of(depth * random.uniform(0.001f, 0.999f), perspective);
    EXPECT_TRUE(maths::ends_occluder(front, behind, perspective));
    EXPECT_FALSE(maths::ends_occluder(front, before, perspective));
    EXPECT_FALSE(maths::ends_occluder(front, front, perspective)) << "a face seen from behind";
    const float rounded = inverse_depth_of(depth * random.uniform(1.0f, 1.00005f), perspective);
    EXPECT_FALSE(maths::ends_occluder(front, rounded, perspective));
    EXPECT_FALSE(maths::ends_occluder(front, maths::sky_inverse_depth(perspective), perspective));
    EXPECT_FALSE(maths::ends_occluder(front, NAN, perspective));
    EXPECT_EQ(maths::farther_inverse_depth(front, behind, perspective), behind);
    EXPECT_EQ(maths::farther_inverse_depth(front, before, perspective), front);
  }
}

// The sectors of an occluder are those between its two ends, whatever lies between.
TEST(SliceLine, BackEndOfAThickOccluderLiesOnTheViewRayThroughItsFront) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    const float offset = random.uniform(1.0f, 60.0f);
    const float depth = s.depth * random.uniform(0.5f, 1.5f);
    const float thickness = s.depth * random.uniform(0.01f, 1.0f);
    const vec2 front = s.point(offset, depth);
    const vec2 back = s.point(offset, depth + thickness);
    const vec3 step = s.delta(s.line.direction_px * offset, depth + thickness) -
                      s.delta(s.line.direction_px * offset, depth);
    EXPECT_NEAR(distance(front, back), length(step), 6e-4f * s.depth);
    EXPECT_LT(back.y, front.y);
  }
}

TEST(SliceLine, SampleOfATiltedPlaneSnappedToATexelCentreStillLiesOnThatPlane) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    if (dot(s.normal, s.view) < 0.1f) continue;
    const maths::TangentPlane tangent = maths::make_tangent_plane(
        s.projection.ray_per_px(), s.normal, s.view, s.depth, s.perspective());
    const vec2 exact = s.line.direction_px * random.uniform(2.0f, 40.0f);
    const vec2 snapped = round(exact);
    const float inverse_depth = tangent.inverse_depth + dot(snapped, tangent.gradient);
    const float on_plane = dot(snapped, tangent.gradient);
    const float off_plane = inverse_depth - tangent.inverse_depth - on_plane;
    EXPECT_TRUE(maths::lies_on_tangent_plane(tangent.fading, off_plane, length(exact)));
    const float at_exact = inverse_depth + dot(exact - snapped, tangent.gradient);
    const float depth = s.perspective() ? 1.0f / at_exact : at_exact;
    // Skip points of the plane that are behind the eye or too far away.
    if (!(depth > 0.0f) || depth > 10.0f * s.depth) continue;
    EXPECT_NEAR(dot(s.delta(exact, depth), s.normal), 0.0f, 2e-4f * depth);
  }
}

TEST(SliceLine, InverseDepthOfAnyRawDepthIsBetweenTheNearPlaneAndTheSky) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Tests perspective views with the near plane at 0.1 and the far plane at 100 or infinity,
  // reversed or not, and orthographic views.
  for (const float ndc : {-kInfinity, -1e30f, -1.0f, 0.0f, 1e-45f, 1e-38f, 0.5f, 0.99999994f, 1.0f,
                          2.0f, 1e30f, kInfinity}) {
    for (const bool reversed : {false, true}) {
      const bool sky = reversed ? !(ndc > 0.0f) : !(ndc < 1.0f);
      for (const float far : {0.0f, 0.01f}) {
        const float depth = maths::inverse_depth_of_ndc({10.0f - far, far}, ndc, true, reversed);
        EXPECT_EQ(depth == maths::sky_inverse_depth(true), sky) << ndc << ' ' << reversed;
        EXPECT_GE(depth, 0.0f) << ndc << ' ' << reversed;
        EXPECT_LE(depth, 10.0f) << ndc << ' ' << reversed;
      }
      const float depth = maths::inverse_depth_of_ndc(
          reversed ? maths::vec2(-20.0f, 10.0f) : maths::vec2(20.0f, -10.0f), ndc, false, reversed);
      EXPECT_EQ(depth == maths::sky_inverse_depth(false), sky) << ndc << ' ' << reversed;
      EXPECT_GE(depth, -10.0f) << ndc << ' ' << reversed;
      EXPECT_TRUE(sky || depth <= 10.0f) << ndc << ' ' << reversed;
    }
  }
}

TEST(SliceLine, SampleCountsAsLyingOnTheTangentPlaneOnlyIfItsDepthIsCloseToThePlane) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const Setting s(random);
    const maths::TangentPlane tangent = maths::make_tangent_plane(
        s.projection.ray_per_px(), s.normal, s.view, s.depth, s.perspective());
    const float offset_px = random.uniform(1.3f, 60.0f);
    const float limit = offset_px / tangent.fading;
    EXPECT_FALSE(maths::lies_on_tangent_plane(tangent.fading, 1.01f * limit, offset_px));
    EXPECT_FALSE(maths::lies_on_tangent_plane(tangent.fading, -1.01f * limit, offset_px));
    EXPECT_TRUE(maths::lies_on_tangent_plane(tangent.fading, 0.99f * limit, offset_px));
  }
}

TEST(SliceLine, ImageLineOfASliceHasTheProjectedDirectionOfTheSlice) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Setting s(random);
    EXPECT_NEAR(length(s.line.direction_px), 1.0f, 1e-5f);
    EXPECT_GE(s.line.x_per_step, 0.0f);
    const vec3 step = 1e-3f * s.depth * s.direction;
    const vec2 along =
        pixel_of(s.projection, s.position + step) - pixel_of(s.projection, s.position - step);
    EXPECT_GT(dot(normalize(along), s.line.direction_px), 0.999f);
  }
}

TEST(SliceLine, RadiusInPixelsApproximatesTheSilhouetteOfASphereOfThatRadius) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    Setting s(random);
    s.normal = s.view;
    const float radius = 0.2f * s.depth;
    // The silhouette of the sphere in this slice: the point at which a view ray within the slice
    // touches the sphere.
    const bool perspective = s.perspective();
    const float away = length(s.position);
    const float sine = radius / away;
    const vec3 touch = perspective ? s.position + s.view * (radius * sine) +
                                         s.direction * (radius * std::sqrt(1.0f - sine * sine))
                                   : s.position + s.direction * radius;
    const float expected = distance(pixel_of(s.projection, touch), s.pixel);
    const float inverse_depth = s.perspective() ? 1.0f / s.depth : s.depth;
    const float reach_px = maths::sphere_reach(s.line, radius, inverse_depth, s.perspective()) *
                           radius / s.line.x_per_step;
    // Away from the view axis, sphere_reach() is exact only to first order in the ratio of radius
    // to distance.
    EXPECT_NEAR(reach_px / expected, 1.0f, 0.35f);
  }
}

const maths::DepthDiscontinuity kNone{false, false}, kConvex{true, false}, kConcave{false, true};

TEST(ConnectedSamples, DepthSamplesAreConnectedAlongPlanesAndAcrossCreasesButNotOverGaps) {
  EXPECT_TRUE(maths::samples_are_connected(kNone, kNone)) << "a plane";
  EXPECT_TRUE(maths::samples_are_connected(kNone, kConcave)) << "a plane that ends";
  EXPECT_TRUE(maths::samples_are_connected(kConvex, kConvex)) << "a crease between the two";
  EXPECT_FALSE(maths::samples_are_connected(kConvex, kConcave))
      << "one surface in front of another";
  EXPECT_FALSE(maths::samples_are_connected(kConcave, kConvex)) << "one surface behind another";
}

TEST(ConnectedSamples, SamplesOfTheSecondDepthLayerAreConnectedAlongPlanesOnly) {
  EXPECT_TRUE(maths::hidden_samples_are_connected(kNone, kNone)) << "a plane";
  EXPECT_TRUE(maths::hidden_samples_are_connected(kNone, kConcave)) << "a plane that ends";
  EXPECT_TRUE(maths::hidden_samples_are_connected(kConvex, kNone)) << "a plane that begins";
  EXPECT_FALSE(maths::hidden_samples_are_connected(kConvex, kConvex))
      << "fragments of several surfaces";
  EXPECT_FALSE(maths::hidden_samples_are_connected(kConvex, kConcave))
      << "one surface in front of another";
}

TEST(ConnectedSamples, BackOfAnOccluderMovesAwayFromTheViewDirectionAsItsThicknessGrows) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec2 front{random.uniform(0.01f, 2.0f), random.uniform(-2.0f, 2.0f)};
    const float scale = 1.0f / (front.x + std::abs(front.y));
    const float height = front.y * scale;
    EXPECT_EQ(maths::height_of_back(height, scale, 0.0f), height) << "no thickness";
    const float thin = maths::height_of_back(height, scale, 1e-3f);
    EXPECT_LT(thin, height);
    EXPECT_LT(maths::height_of_back(height, scale, 2e-3f), thin);
    // A diamond angle falls by thickness * scale * (1 - |height|) with a small thickness.
    EXPECT_NEAR((height - thin) / 1.5e-3f, scale * (1.0f - std::abs(height)), 0.02f * scale);
  }
}

TEST(ConnectedSamples,
     PointsAreOccludersOnlyIfTheyRiseMoreThanAFifthOfTheirDistanceAboveTheTangentPlane) {
  for (const double gamma : {-0.8, 0.0, 0.8}) {
    const vec2 gradient(std::sin(gamma), std::cos(gamma));
    for (const double length : {0.1, 10.0}) {
      const auto at = [&](double sine_of_height) {
        const double angle = std::acos(sine_of_height) + gamma;
        return vec2(float(length * std::sin(angle)), float(length * std::cos(angle)));
      };
      EXPECT_FALSE(maths::stands_above_tangent(at(0.0), gradient));
      EXPECT_FALSE(maths::stands_above_tangent(at(0.19), gradient));
      EXPECT_FALSE(maths::stands_above_tangent(at(-0.5), gradient));
      EXPECT_TRUE(maths::stands_above_tangent(at(0.21), gradient));
    }
  }
}

TEST(ConnectedSamples, OnlySlopeChangesAboveTheThresholdAreDepthDiscontinuities) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float before = random.uniform(-1.0f, 1.0f), after = random.uniform(-1.0f, 1.0f);
    const float width = random.uniform(0.5f, 5.0f), next = random.uniform(0.5f, 5.0f);
    const auto discontinuity =
        maths::depth_discontinuity(before * width, width, after * next, next, 0.1f);
    const float change = before - after;
    if (std::abs(std::abs(change) - 0.1f) > 1e-4f) {
      EXPECT_EQ(discontinuity.convex, change > 0.1f);
      EXPECT_EQ(discontinuity.concave, change < -0.1f);
    }
  }
}

TEST(ConnectedSamples, ExtrapolationOfAPlaneBeyondTheImageBorderStopsBeforeItReachesTheEye) {
  EXPECT_EQ(maths::extrapolated_way(0.5f, 0.25f, 8.0f, true), 8.0f) << "the plane comes nearer";
  EXPECT_EQ(maths::extrapolated_way(0.5f, -0.03125f, 8.0f, true), 8.0f);
  EXPECT_FLOAT_EQ(maths::extrapolated_way(0.5f, -0.25f, 8.0f, true), 1.8f);
  EXPECT_EQ(maths::extrapolated_way(0.5f, -0.25f, 8.0f, false), 8.0f) << "orthographic";
}

TEST(TangentPlane, NormalIsRecoveredFromTheGradientOfInverseDepthOfItsTangentPlane) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const bool perspective = i % 2 == 0;
    const vec2 per_px{random.uniform(1e-4f, 1e-1f), -random.uniform(1e-4f, 1e-1f)};
    const vec2 slope = perspective ? vec2{random.uniform(-2, 2), random.uniform(-2, 2)} : vec2(0);
    const vec3 view = normalize(vec3(-slope.x, -slope.y, 1.0f));
    const vec3 normal = random.facing(view);
    if (dot(normal, view) < 0.05f) continue;
    const float depth = random.log_uniform(1e-2f, 1e6f);
    const maths::TangentPlane t =
        maths::make_tangent_plane(per_px, normal, view, depth, perspective);
    EXPECT_LT(
        distance(maths::normal_of_gradient(per_px, slope, t.inverse_depth, t.gradient, perspective),
                 normal),
        2e-4f);
  }
}

}  // namespace
}  // namespace alcove::maths_test
