#include "maths/slice_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "maths/connected_samples.h"
#include "maths/make_projection.h"
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
  const vec2 shift(random.uniform(-0.3f, 0.3f), random.uniform(-0.3f, 0.3f));
  m[0][0] = random.uniform(0.5f, 2.0f);
  m[1][1] = (random.bits() % 2 == 0 ? -1.0f : 1.0f) * random.uniform(0.5f, 2.0f);
  if (random.bits() % 2 == 0) {
    m[2] = glm::vec4(shift, -1.0f, -1.0f);
    m[3][2] = -0.1f;
  } else {
    m[2][2] = -0.01f;
    m[3] = glm::vec4(shift, 0.0f, 1.0f);
  }
  return maths::make_projection(m, kWidth, kHeight).value();
}

// A point of a surface, a slice through it and the line of that slice.
struct Setting {
  Projection projection;
  vec2 pixel;
  float depth;
  vec3 position, view, normal, direction;
  SliceLine line;

  explicit Setting(RandomInput& random)
      : projection(some_projection(random)),
        pixel(random.uniform(0, kWidth), random.uniform(0, kHeight)),
        depth(random.uniform(1.0f, 20.0f)),
        position(maths::position_vs(projection, pixel * projection.texel_uv, depth)),
        view(maths::view_vector(projection, position)),
        normal(maths::facing_normal(random.unit_vector(), view)),
        direction(maths::slice_direction(maths::make_view_basis(view), random.uniform(0, 6.28f))),
        line(maths::make_slice_line(maths::ray_per_px(projection), direction, view)) {}

  bool perspective() const { return projection.eye.w > 0.0f; }

  vec3 delta(vec2 offset_px, float sample_depth) const {
    return maths::position_vs(projection, (pixel + offset_px) * projection.texel_uv, sample_depth) -
           position;
  }

  vec2 point(float offset_px, float sample_depth) const {
    const float sample_line = perspective() ? 1.0f / sample_depth : sample_depth;
    const vec3 scaled = maths::slice_point(line, offset_px, sample_line, depth, perspective());
    return vec2(scaled) / scaled.z;
  }
};

TEST(SliceLine, ASampleOnTheLineKeepsItsCoordinates) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    const float offset = random.uniform(-60.0f, 60.0f);
    const float depth = s.depth * random.uniform(0.5f, 2.0f);
    const vec3 delta = s.delta(s.line.direction_px * offset, depth);
    ASSERT_NEAR(dot(delta, cross(s.view, s.direction)), 0.0f, 1e-4f * s.depth) << "the premise";
    const vec2 point = s.point(offset, depth);
    EXPECT_NEAR(point.x, dot(delta, s.direction), 3e-4f * s.depth);
    EXPECT_NEAR(point.y, dot(delta, s.view), 3e-4f * s.depth);
  }
}

float inverse_depth_of(float depth, bool perspective) { return perspective ? 1.0f / depth : depth; }

TEST(SliceLine, ABackFaceEndsAnOccluderOnlyBehindItsFront) {
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

// So that the sectors of an occluder are those between its two ends, whatever lies between them.
TEST(SliceLine, AnOccludersBackLiesOnTheViewRayOfItsFront) {
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

TEST(SliceLine, ASampleOfTheTangentPlaneIsMovedAlongIt) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    if (dot(s.normal, s.view) < 0.1f) continue;
    const maths::TangentPlane tangent = maths::make_tangent_plane(
        maths::ray_per_px(s.projection), s.normal, s.view, s.depth, s.perspective());
    const vec2 exact = s.line.direction_px * random.uniform(2.0f, 40.0f);
    const vec2 snapped = round(exact);
    const float line = tangent.inverse_depth + dot(snapped, tangent.gradient);
    const float on_plane = dot(snapped, tangent.gradient);
    const float share =
        maths::tangent_share(tangent, line - tangent.inverse_depth - on_plane, length(exact));
    const float moved = line + share * dot(exact - snapped, tangent.gradient);
    const float depth = s.perspective() ? 1.0f / moved : moved;
    // A plane that passes behind the eye has no image there.
    if (!(depth > 0.0f) || depth > 10.0f * s.depth) continue;
    EXPECT_NEAR(dot(s.delta(exact, depth), s.normal), 0.0f, 2e-4f * depth);
  }
}

TEST(SliceLine, AMovedSampleStaysBeforeTheEyeAndTheSkyAfar) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const float line = random.log_uniform(1e-12f, 1e4f);
    const float by = random.log_uniform(1e-6f, 1e6f) * (i % 2 == 0 ? 1.0f : -1.0f);
    const float moved = maths::moved_inverse_depth(line, by, true);
    EXPECT_GT(moved, 0.0f);
    EXPECT_LE(moved, 10.0f * line);
    // Orthographic depth may be negative, and is moved all the way.
    EXPECT_EQ(maths::moved_inverse_depth(-line, by, false), -line + by);
  }
}

TEST(SliceLine, RawDepthOfAnyKindIsBetweenTheNearPlaneAndTheSky) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Reversed and infinite with a near plane at 0.1; that of rounded matrices, whose far plane lies
  // behind infinity; orthographic.
  for (const float ndc : {-kInfinity, -1e30f, -1.0f, 0.0f, 1e-45f, 1e-38f, 0.5f, 0.99999994f, 1.0f,
                          2.0f, 1e30f, kInfinity}) {
    const float reversed = maths::inverse_depth_of_ndc({10.0f, 0.0f, 0.0f}, ndc, true);
    EXPECT_GE(reversed, maths::sky_inverse_depth(true)) << ndc;
    EXPECT_LE(reversed, 10.0f) << ndc;
    const float rounded = maths::inverse_depth_of_ndc({-10.0f, 1.0f, -6e-7f}, ndc, true);
    EXPECT_GE(rounded, maths::sky_inverse_depth(true)) << ndc;
    EXPECT_LE(rounded, 10.0f) << ndc;
    const float orthographic = maths::inverse_depth_of_ndc({20.0f, 0.0f, -10.0f}, ndc, false);
    EXPECT_GE(orthographic, -10.0f) << ndc;
    EXPECT_LE(orthographic, 10.0f) << ndc;
  }
}

TEST(SliceLine, ASampleFarOffTheTangentPlaneIsLeftAsItIs) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const Setting s(random);
    const maths::TangentPlane tangent = maths::make_tangent_plane(
        maths::ray_per_px(s.projection), s.normal, s.view, s.depth, s.perspective());
    const float offset_px = random.uniform(1.3f, 60.0f);
    EXPECT_EQ(maths::tangent_share(tangent, 1.01f * offset_px / tangent.fading, offset_px), 0.0f);
    EXPECT_EQ(maths::tangent_share(tangent, -1.01f * offset_px / tangent.fading, offset_px), 0.0f);
  }
}

TEST(SliceLine, RunsTheWayOfTheSlicesDirection) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Setting s(random);
    EXPECT_NEAR(length(s.line.direction_px), 1.0f, 1e-5f);
    EXPECT_GE(s.line.x_per_step, 0.0f);
    const vec3 step = 1e-3f * s.depth * s.direction;
    const vec2 along = (uv_of_position(s.projection, s.position + step) -
                        uv_of_position(s.projection, s.position - step)) *
                       s.projection.size_px;
    EXPECT_GT(dot(normalize(along), s.line.direction_px), 0.999f);
  }
}

TEST(SliceLine, RadiusSpansTheSilhouetteOfItsSphere) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    Setting s(random);
    s.normal = s.view;
    const float radius = 0.2f * s.depth;
    // The sphere's silhouette in this slice: where a ray of the plane touches it.
    const bool perspective = s.projection.eye.w > 0.0f;
    const float away = length(s.position);
    const float sine = radius / away;
    const vec3 touch = perspective ? s.position + s.view * (radius * sine) +
                                         s.direction * (radius * std::sqrt(1.0f - sine * sine))
                                   : s.position + s.direction * radius;
    const vec2 imaged = uv_of_position(s.projection, touch) * s.projection.size_px;
    const float expected = distance(imaged, s.pixel);
    const float spanned = maths::slice_radius_px(s.line, radius, s.depth, s.perspective());
    // To first order in the sphere's size against its distance, off the axis.
    EXPECT_NEAR(spanned / expected, 1.0f, 0.35f);
  }
}

TEST(ConnectedSamples, JoinAlongAPlaneAndAcrossACreaseButNotOverAGap) {
  EXPECT_TRUE(maths::samples_join(0.0f, 0.0f)) << "a plane";
  EXPECT_TRUE(maths::samples_join(0.0f, -3.0f)) << "a plane that ends";
  EXPECT_TRUE(maths::samples_join(2.0f, 1.0f)) << "a crease between the two";
  EXPECT_FALSE(maths::samples_join(2.0f, -1.0f)) << "one surface in front of another";
}

TEST(ConnectedSamples, OfWhatIsHiddenJoinAlongAPlaneAlone) {
  EXPECT_TRUE(maths::hidden_samples_join(0.0f, 0.0f)) << "a plane";
  EXPECT_TRUE(maths::hidden_samples_join(0.0f, -3.0f)) << "a plane that ends";
  EXPECT_TRUE(maths::hidden_samples_join(2.0f, 0.0f)) << "and one that begins";
  EXPECT_FALSE(maths::hidden_samples_join(2.0f, 1.0f)) << "shreds";
  EXPECT_FALSE(maths::hidden_samples_join(2.0f, -1.0f)) << "one surface in front of another";
}

TEST(ConnectedSamples, ASurfaceThatBeginsIsNoThickerThanWhatIsDrawnOfIt) {
  EXPECT_EQ(maths::sample_thickness(0.5f, true, 0.2f), 0.2f);
  EXPECT_EQ(maths::sample_thickness(0.5f, true, 2.0f), 0.5f);
  EXPECT_EQ(maths::sample_thickness(0.5f, false, 0.2f), 0.5f);
}

TEST(ConnectedSamples, OnlySharpBendsCountAndTheirSignIsTheTurns) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float before = random.uniform(-1.0f, 1.0f), after = random.uniform(-1.0f, 1.0f);
    const float step = random.uniform(0.5f, 5.0f), next = random.uniform(0.5f, 5.0f);
    const float residual =
        maths::depth_discontinuity(before * step, step, after * next, next, 0.1f);
    const float turn = before - after;
    if (std::abs(turn) < 0.0999f) {
      EXPECT_EQ(residual, 0.0f);
    } else if (std::abs(turn) > 0.1001f) {
      EXPECT_NEAR(residual / (step * next), turn, 1e-5f);
    }
  }
}

TEST(ConnectedSamples, ASheetIsCutWhereItLeavesTheRadius) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec2 inside = random.uniform(0.1f, 0.9f) * normalize(vec2(random.uniform(0, 1), 1.0f));
    const vec2 outside = random.uniform(1.1f, 9.0f) * normalize(vec2(1.0f, random.uniform(-1, 1)));
    // In proportion to the distances from the shaded point.
    const float part = (1.0f - length(inside)) / (length(outside) - length(inside));
    const vec2 expected = normalize(mix(inside, outside, part));
    const vec3 a = vec3(inside, 1.0f) * random.uniform(0.1f, 2.0f);
    const vec3 b = vec3(outside, 1.0f) * random.uniform(0.1f, 2.0f);
    const float ea = maths::radius_excess(a, 1.0f), eb = maths::radius_excess(b, 1.0f);
    EXPECT_LT(ea, 0.0f);
    EXPECT_GT(eb, 0.0f);
    EXPECT_LT(distance(normalize(maths::radius_crossing(a, ea, b, eb)), expected), 1e-4f);
    EXPECT_LT(distance(normalize(maths::radius_crossing(b, eb, a, ea)), expected), 1e-4f);
  }
}

TEST(ConnectedSamples, APlaneGoesOnWhereItWent) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Setting s(random);
    // A plane in the image: `line` is linear along it.
    const float line = inverse_depth_of(s.depth, s.perspective());
    const float slope = line * random.uniform(-0.004f, 0.004f);
    const auto at = [&](float offset) {
      return maths::slice_point(s.line, offset, line + slope * offset, s.depth, s.perspective());
    };
    const float last = random.uniform(2.0f, 30.0f), here = last + random.uniform(1.0f, 20.0f);
    const float further = random.uniform(0.0f, 100.0f);
    const vec3 expected = at(here + further);
    const vec3 found =
        maths::extrapolated_point(at(here), at(here) - at(last), further * s.line.x_per_step);
    EXPECT_LT(distance(found, expected), 1e-3f * length(expected));
  }
}

TEST(ConnectedSamples, APlaneThatGoesOnStaysInFrontOfTheEye) {
  const vec3 here(1.0f, 2.0f, 0.5f);
  EXPECT_EQ(maths::extrapolated_point(here, vec3(0.0f, 1.0f, 0.1f), 3.0f), here) << "went nowhere";
  const vec3 end = maths::extrapolated_point(here, vec3(1.0f, 1.0f, -0.1f), 1e6f);
  EXPECT_NEAR(end.z, 0.05f, 1e-6f);
  EXPECT_NEAR(end.x, 5.5f, 1e-5f);
}

TEST(TangentPlane, ItsGradientGivesTheNormalBack) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const bool perspective = i % 2 == 0;
    const vec2 per_px(random.uniform(1e-4f, 1e-1f), -random.uniform(1e-4f, 1e-1f));
    const vec2 slope = perspective ? vec2(random.uniform(-2, 2), random.uniform(-2, 2)) : vec2(0);
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
