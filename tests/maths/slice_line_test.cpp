#include "maths/slice_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

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
        line(maths::make_slice_line(maths::ray_per_px(projection), direction, view)) {}

  bool perspective() const { return projection.eye.w > 0.0f; }

  vec3 delta(vec2 offset_px, float sample_depth) const {
    return maths::position_vs(projection, (pixel + offset_px) * projection.texel_uv, sample_depth) -
           position;
  }

  vec2 point(float offset_px, float sample_depth) const {
    return maths::slice_point(line, offset_px, sample_depth, depth,
                              maths::sample_scale(projection, sample_depth));
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

TEST(SliceLine, ASampleOfTheTangentPlaneIsMovedAlongIt) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Setting s(random);
    if (dot(s.normal, s.view) < 0.1f) continue;
    const maths::TangentLine tangent = maths::make_tangent_line(
        maths::ray_per_px(s.projection), s.normal, s.view, s.depth, s.perspective());
    const vec2 exact = s.line.direction_px * random.uniform(2.0f, 40.0f);
    const vec2 snapped = round(exact);
    const float line = tangent.line + dot(snapped, tangent.gradient);
    const float share = maths::tangent_share(tangent, snapped, line, 1.0f / length(exact));
    const float moved = line + share * dot(exact - snapped, tangent.gradient);
    const float depth = s.perspective() ? 1.0f / moved : moved;
    // A plane that passes behind the eye has no image there.
    if (!(depth > 0.0f) || depth > 10.0f * s.depth) continue;
    EXPECT_NEAR(dot(s.delta(exact, depth), s.normal), 0.0f, 2e-4f * depth);
  }
}

TEST(SliceLine, ASampleFarOffTheTangentPlaneIsLeftAsItIs) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const Setting s(random);
    const maths::TangentLine tangent = maths::make_tangent_line(
        maths::ray_per_px(s.projection), s.normal, s.view, s.depth, s.perspective());
    const vec2 exact(10.3f, -4.4f), snapped(10.0f, -4.0f);
    const float line =
        tangent.line + dot(snapped, tangent.gradient) + 1.01f * length(exact) / tangent.fading;
    EXPECT_EQ(maths::tangent_share(tangent, snapped, line, 1.0f / length(exact)), 0.0f);
  }
}

TEST(SliceLine, RunsTheWayOfTheSlicesDirection) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Setting s(random);
    EXPECT_NEAR(length(s.line.direction_px), 1.0f, 1e-5f);
    EXPECT_GE(s.line.x_per_step, 0.0f);
    const vec2 along = maths::pixels_along(s.projection, s.direction, s.view, s.depth);
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
    const vec2 imaged = maths::uv_of_position(s.projection, touch) * s.projection.size_px;
    const float expected = distance(imaged, s.pixel);
    const float spanned = maths::slice_radius_px(s.line, radius, s.depth, s.perspective());
    // To first order in the sphere's size against its distance, off the axis.
    EXPECT_NEAR(spanned / expected, 1.0f, 0.35f);
  }
}

TEST(ConnectedSamples, JoinAlongAPlaneAndAcrossACreaseButNotOverAGap) {
  const float sharp = 0.1f;
  EXPECT_TRUE(maths::samples_join(0.0f, 0.0f, sharp)) << "a plane";
  EXPECT_TRUE(maths::samples_join(0.0f, -3.0f, sharp)) << "a plane that ends";
  EXPECT_TRUE(maths::samples_join(2.0f, 1.0f, sharp)) << "a crease between the two";
  EXPECT_TRUE(maths::samples_join(0.05f, -3.0f, sharp)) << "a surface that hardly bends";
  EXPECT_FALSE(maths::samples_join(2.0f, -1.0f, sharp)) << "one surface in front of another";
}

TEST(ConnectedSamples, SlopeIsThatOfThePlane) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const float slope = random.uniform(-10.0f, 10.0f);
    maths::LineSample from, to;
    from.offset_px = random.uniform(1.0f, 5.0f);
    to.offset_px = from.offset_px + random.uniform(0.5f, 5.0f);
    from.line = 1.0f + slope * from.offset_px;
    to.line = 1.0f + slope * to.offset_px;
    EXPECT_NEAR(maths::line_slope(from, to), slope, 1e-3f);
  }
}

TEST(ConnectedSamples, EdgePositionIsTheSectorPositionWithinAFifthOfASector) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const vec3 view = random.unit_vector();
    const vec3 normal = maths::facing_normal(random.unit_vector(), view);
    const vec3 other = random.unit_vector();
    const vec3 direction = normalize(other - view * dot(other, view));
    const maths::Slice slice = maths::make_slice(normal, direction, view);
    if (slice.scale < 0.01f) continue;
    const maths::SectorScale scale = maths::make_sector_scale(slice);
    const float side = random.bits() % 2 == 0 ? 1.0f : -1.0f;
    const vec2 point(random.uniform(0.0f, 1.0f), random.uniform(-1.0f, 1.0f));
    const float exact = 32.0f * maths::sector_position(slice, scale, side, point.y / length(point));
    const float found = maths::edge_position(maths::make_edge_scale(slice, scale, side), point);
    EXPECT_NEAR(found, exact, 0.2f) << "side " << side;
  }
}

TEST(ConnectedSamples, SectorsBetweenPositionsAreThoseWithinThem) {
  for (int from = 0; from <= 32; ++from) {
    for (int to = 0; to <= 32; ++to) {
      std::uint32_t expected = 0;
      for (int k = std::min(from, to); k < std::max(from, to); ++k) expected |= 1u << k;
      EXPECT_EQ(maths::sectors_between(static_cast<float>(from) + 0.2f,
                                       static_cast<float>(to) - 0.2f * (to > 0 ? 1.0f : 0.0f)),
                expected);
    }
  }
}

TEST(ConnectedSamples, FillingGoesFromTheHighestOccluderToTheTangentPlane) {
  EXPECT_EQ(maths::filled_sectors(1.0f, 0u), 0u);
  EXPECT_EQ(maths::filled_sectors(-1.0f, 0u), 0u);
  EXPECT_EQ(maths::filled_sectors(1.0f, 0x00110000u), 0xffff0000u);
  EXPECT_EQ(maths::filled_sectors(-1.0f, 0x00000110u), 0x000001ffu);
  EXPECT_EQ(maths::filled_sectors(-1.0f, 0x80000000u), 0xffffffffu);
}

TEST(ConnectedSamples, ASheetIsCutAtTheRadius) {
  const vec2 inside(0.6f, 0.0f), outside(3.0f, 0.0f);
  EXPECT_NEAR(maths::radius_crossing(outside, 3.0f, inside, 0.6f, 1.0f).x, 1.0f, 1e-6f);
  EXPECT_NEAR(maths::radius_crossing(inside, 0.6f, outside, 3.0f, 1.0f).x, 1.0f, 1e-6f);
}

}  // namespace
}  // namespace alcove::maths_test
