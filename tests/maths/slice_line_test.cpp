#include "maths/slice_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maths/connected_samples.h"
#include "maths/make_projection.h"
#include "maths/slice.h"
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
        line(maths::make_slice_line(maths::ray_per_px(projection), normal, direction, view)) {}

  // Where the plane of slice and tangent plane part so little that no sample is carried far.
  bool carries_well() const { return std::abs(dot(normal, cross(view, direction))) < 0.95f; }

  vec3 delta(vec2 offset_px, float sample_depth) const {
    return maths::position_vs(projection, (pixel + offset_px) * projection.texel_uv, sample_depth) -
           position;
  }

  vec2 point(vec2 offset_px, float sample_depth) const {
    return maths::slice_point(line, offset_px, sample_depth, depth,
                              maths::sample_scale(projection, sample_depth));
  }
};

TEST(SliceLine, ASampleInThePlaneKeepsItsCoordinates) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    if (!s.carries_well()) continue;
    const vec2 offset = s.line.direction_px * random.uniform(-60.0f, 60.0f);
    const float depth = s.depth * random.uniform(0.5f, 2.0f);
    const vec3 delta = s.delta(offset, depth);
    ASSERT_NEAR(dot(delta, cross(s.view, s.direction)), 0.0f, 1e-4f * s.depth) << "the premise";
    const vec2 point = s.point(offset, depth);
    EXPECT_NEAR(point.x, dot(delta, s.direction), 3e-4f * s.depth);
    EXPECT_NEAR(point.y, dot(delta, s.view), 3e-4f * s.depth);
  }
}

TEST(SliceLine, ASampleBesideThePlaneKeepsItsHeightAboveTheSurface) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    if (!s.carries_well()) continue;
    const vec2 offset(random.uniform(-60.0f, 60.0f), random.uniform(-60.0f, 60.0f));
    const float depth = s.depth * random.uniform(0.5f, 2.0f);
    const vec2 point = s.point(offset, depth);
    const float height = point.x * dot(s.normal, s.direction) + point.y * dot(s.normal, s.view);
    EXPECT_NEAR(height, dot(s.delta(offset, depth), s.normal), 3e-4f * s.depth);
  }
}

TEST(SliceLine, RunsTheWayOfTheSlicesDirection) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Setting s(random);
    EXPECT_NEAR(length(s.line.direction_px), 1.0f, 1e-5f);
    EXPECT_GE(s.line.x_per_step, 0.0f);
    if (!s.carries_well()) continue;
    const vec2 along = maths::pixels_along(s.projection, s.direction, s.view, s.depth);
    EXPECT_GT(dot(normalize(along), s.line.direction_px), 0.999f);
  }
}

TEST(SliceLine, RadiusSpansTheSilhouetteOfItsSphere) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    Setting s(random);
    s.normal = s.view;
    s.line = maths::make_slice_line(maths::ray_per_px(s.projection), s.normal, s.direction, s.view);
    const float radius = 0.2f * s.depth;
    // The sphere's silhouette in this slice: where a ray of the plane touches it.
    const bool perspective = s.projection.eye.w > 0.0f;
    const float away = length(s.position);
    const float sine = radius / away;
    const vec3 touch = perspective ? s.position + s.view * (radius * sine) +
                                         s.direction * (radius * std::sqrt(1.0f - sine * sine))
                                   : s.position + s.direction * radius;
    const vec2 imaged = maths::uv_of_position(s.projection, touch) * s.projection.size_px;
    const float expected = distance(imaged, s.pixel);
    const float spanned = maths::slice_radius_px(s.projection, s.line, radius, s.depth);
    // To first order in the sphere's size against its distance, off the axis.
    EXPECT_NEAR(spanned / expected, 1.0f, 0.35f);
  }
}

TEST(SliceLine, SliceThatDoesNotMeetTheSurfaceStaysFinite) {
  const vec3 view(0, 0, 1), direction(1, 0, 0), normal(0, 1, 0);
  const SliceLine line = maths::make_slice_line(vec2(0.01f), normal, direction, view);
  const vec2 point = maths::slice_point(line, vec2(3, 4), 1.0f, 1.0f, 1.0f);
  EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y));
}

maths::LineSample at(float offset_px, float line) {
  maths::LineSample sample;
  sample.offset_px = offset_px;
  sample.line = line;
  return sample;
}

TEST(ConnectedSamples, JoinOnAPlaneAtAnySlope) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const float slope = random.uniform(-10.0f, 10.0f);
    const auto on_plane = [&](float x) { return at(x, 1.0f + slope * x); };
    EXPECT_TRUE(
        maths::samples_connect(on_plane(1), on_plane(2.5f), on_plane(5), on_plane(9), 1e-3f));
  }
}

TEST(ConnectedSamples, JoinAcrossACreaseAndPartAtAStep) {
  // A floor that meets a wall between the middle samples.
  EXPECT_TRUE(maths::samples_connect(at(0, 1), at(1, 1), at(2, 1.5f), at(3, 2.5f), 1e-3f));
  // Two level surfaces, one in front of the other.
  EXPECT_FALSE(maths::samples_connect(at(0, 1), at(1, 1), at(2, 3), at(3, 3), 1e-3f));
}

}  // namespace
}  // namespace alcove::maths_test
