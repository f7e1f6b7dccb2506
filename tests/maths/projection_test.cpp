#include "maths/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "projection_truth.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using maths::Projection;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A view frustum. In perspective, left, right, bottom and top are coordinates in the plane at
// distance 1.
struct Frustum {
  double left = -1, right = 1, bottom = -1, top = 1, near = 0.1, far = 100;
  bool perspective = true, infinite = false, reversed = false, flipped = false;
  glm::dvec2 jitter{0};  // in normalised device coordinates
};

// The Vulkan projection matrix of a frustum, from the definition of each kind.
mat4 matrix_of(const Frustum& f) {
  glm::dmat4 m(0.0);
  const double width = f.right - f.left, height = f.top - f.bottom;
  m[0][0] = 2 / width;
  m[1][1] = -2 / height;
  const glm::dvec2 centre(-(f.right + f.left) / width, (f.top + f.bottom) / height);
  if (f.perspective) {
    m[2] = glm::dvec4(-centre.x - f.jitter.x, -centre.y - f.jitter.y, 0, -1);
    if (f.infinite) {
      m[2][2] = -1;
      m[3][2] = -f.near;
    } else {
      m[2][2] = f.far / (f.near - f.far);
      m[3][2] = f.far * f.near / (f.near - f.far);
    }
  } else {
    m[3] = glm::dvec4(centre.x + f.jitter.x, centre.y + f.jitter.y, 0, 1);
    m[2][2] = -1 / (f.far - f.near);
    m[3][2] = -f.near / (f.far - f.near);
  }
  if (f.flipped)
    for (int column = 0; column < 4; ++column) m[column][1] = -m[column][1];
  if (f.reversed)
    for (int column = 0; column < 4; ++column) m[column][2] = m[column][3] - m[column][2];
  return mat4(m);
}

Frustum random_frustum(RandomInput& random) {
  Frustum f;
  f.perspective = random.bits() % 3 != 0;
  f.infinite = f.perspective && random.bits() % 2 == 0;
  f.reversed = random.bits() % 2 == 0;
  f.flipped = random.bits() % 2 == 0;
  f.left = random.uniform(-2.0f, 0.4f);
  f.right = f.left + random.uniform(0.1f, 3.0f);
  f.bottom = random.uniform(-2.0f, 0.4f);
  f.top = f.bottom + random.uniform(0.1f, 3.0f);
  f.near = random.log_uniform(1e-3f, 10.0f);
  if (!f.perspective && random.bits() % 2 == 0) f.near = -f.near;
  f.far = std::max(f.near, 0.0) + random.log_uniform(1.0f, 1e5f);
  f.jitter = {random.uniform(-1e-3f, 1e-3f), random.uniform(-1e-3f, 1e-3f)};
  return f;
}

std::string describe(const Frustum& f) {
  return std::string(f.perspective ? "perspective" : "orthographic") +
         (f.infinite ? " infinite" : "") + (f.reversed ? " reversed" : "") +
         (f.flipped ? " flipped" : "") + " near " + std::to_string(f.near) + " far " +
         std::to_string(f.far);
}

Projection projection_of(const Frustum& f, unsigned width = 960, unsigned height = 540) {
  const auto p = maths::make_projection(matrix_of(f), width, height);
  EXPECT_TRUE(p.has_value()) << (p ? "" : p.error()) << ": " << describe(f);
  return p.value_or(Projection{});
}

struct ImagePoint {
  glm::dvec2 uv;
  double depth_ndc;
};

// The image of a view-space point, computed with the matrix itself.
ImagePoint project(const mat4& matrix, glm::dvec3 position) {
  const glm::dvec4 clip = glm::dmat4(matrix) * glm::dvec4(position, 1.0);
  return {glm::dvec2(clip.x, clip.y) / clip.w * 0.5 + 0.5, clip.z / clip.w};
}

TEST(Projection, PositionsFromDepthProjectBackToTheirPixelByTheProjectionMatrix) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const Frustum f = random_frustum(random);
    const Projection p = projection_of(f);
    const float depth =
        float(f.perspective ? f.near * random.log_uniform(1.01f, 1e4f)
                            : f.near + random.uniform(0.01f, 0.99f) * (f.far - f.near));
    const vec2 uv{random.uniform(0, 1), random.uniform(0, 1)};
    const vec3 position = position_at(p, uv * p.size_px, depth);
    EXPECT_EQ(position.z, -depth);
    const ImagePoint point = project(matrix_of(f), position);
    EXPECT_NEAR(point.uv.x, uv.x, 3e-4) << describe(f);
    EXPECT_NEAR(point.uv.y, uv.y, 3e-4) << describe(f);
    const vec2 back = pixel_of(p, position) / p.size_px;
    EXPECT_NEAR(back.x, uv.x, 1e-4) << describe(f);
    EXPECT_NEAR(back.y, uv.y, 1e-4) << describe(f);
  }
}

TEST(Projection, RawDepthConvertsToTheDistanceItWasMadeFrom) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const Frustum f = random_frustum(random);
    const Projection p = projection_of(f);
    const mat4 matrix = matrix_of(f);
    const double farthest = f.infinite ? 1e3 * f.near : f.far;
    const double depth = f.near + random.uniform(0.001f, 0.999f) * (farthest - f.near);
    const double exact = project(matrix, glm::dvec3(0, 0, -depth)).depth_ndc;
    const float ndc = float(exact);
    // The raw depth and the matrix are floats, so that two depths cannot be distinguished if they
    // differ by less than a few steps of the raw depth.
    const double step = 4e-7;
    const double slope =
        std::abs(project(matrix, glm::dvec3(0, 0, -depth * 1.001)).depth_ndc - exact) /
        (std::abs(depth) * 0.001);
    const double tolerance = step / std::max(slope, 1e-30) + 1e-5 * std::abs(depth);
    const bool rounded_to_the_sky = ndc == (f.reversed ? 0.0f : 1.0f);
    if (rounded_to_the_sky || tolerance > 0.1 * std::abs(depth)) continue;
    EXPECT_NEAR(linear_depth(p, ndc), depth, 2 * tolerance) << describe(f);
    EXPECT_FALSE(maths::is_sky_ndc(ndc, p.reversed)) << describe(f) << " depth " << depth;
  }
}

TEST(Projection, ReversedDepthWithAnInfiniteFarPlaneIsPreciseFarAway) {
  Frustum f;
  f.infinite = f.reversed = true;
  const Projection p = projection_of(f);
  for (const float depth : {0.1f, 1.0f, 1e3f, 1e5f, 1e7f})
    EXPECT_NEAR(linear_depth(p, 0.1f / depth) / depth, 1.0f, 1e-6f);
}

TEST(Projection, NearAndFarPlanesReadFromTheMatrixEqualThoseOfTheFrustum) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Frustum f = random_frustum(random);
    const Projection p = projection_of(f);
    // The far plane of a finite perspective is computed from a difference of nearly equal numbers.
    const double slack = f.perspective ? 2e-7 * f.far / f.near : 2e-6;
    if (slack > 0.1) continue;
    EXPECT_NEAR(p.near_far.x, f.near, 1e-5 * std::max(std::abs(f.near), f.far * 0.1));
    if (f.infinite)
      EXPECT_EQ(p.near_far.y, maths::kSkyDepth);
    else
      EXPECT_NEAR(p.near_far.y / f.far, 1.0, slack) << describe(f);
  }
}

TEST(Projection, DepthsOnOrBeyondTheFarPlaneAndNaNAreSky) {
  for (const bool infinite : {false, true}) {
    for (const bool perspective : {false, true}) {
      Frustum f;
      f.perspective = perspective;
      f.infinite = infinite && perspective;
      const Projection standard = projection_of(f);
      for (const float ndc : {1.0f, 1.5f, kInfinity, kNan}) {
        EXPECT_TRUE(maths::is_sky_ndc(ndc, standard.reversed)) << ndc;
        EXPECT_EQ(linear_depth(standard, ndc), maths::kSkyDepth);
      }
      f.reversed = true;
      const Projection reversed = projection_of(f);
      for (const float ndc : {0.0f, -0.0f, -1.0f, -kInfinity, kNan}) {
        EXPECT_TRUE(maths::is_sky_ndc(ndc, reversed.reversed)) << ndc;
        EXPECT_EQ(linear_depth(reversed, ndc), maths::kSkyDepth);
      }
    }
  }
}

TEST(Projection, AnyRawDepthGivesAFiniteDistanceNoNearerThanTheNearPlane) {
  RandomInput random;
  for (int i = 0; i < 500; ++i) {
    const Frustum f = random_frustum(random);
    const Projection p = projection_of(f);
    for (const float ndc :
         {0.0f, 1e-45f, 1e-38f, 1e-20f, 0.5f, 1.0f - 6e-8f, -kInfinity, kInfinity, -3.0f, 3.0f}) {
      const float depth = linear_depth(p, ndc);
      EXPECT_TRUE(std::isfinite(depth)) << describe(f) << " ndc " << ndc;
      EXPECT_GE(depth, f.near - 1e-5 * std::max(std::abs(f.near), f.far * 0.1)) << describe(f);
      EXPECT_LE(depth, maths::kSkyDepth);
    }
  }
}

TEST(Projection, ViewDirectionPointsFromTheSurfaceToTheEye) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Frustum f = random_frustum(random);
    const Projection p = projection_of(f);
    const vec2 pixel = vec2{random.uniform(0, 1), random.uniform(0, 1)} * p.size_px;
    const float depth = float(std::abs(f.near)) * random.uniform(2.0f, 50.0f);
    const vec3 near = position_at(p, pixel, depth);
    const vec3 behind = position_at(p, pixel, depth * 3.0f);
    EXPECT_LT(distance(view_at(p, pixel), normalize(near - behind)), 2e-4f) << describe(f);
  }
}

TEST(Projection, ViewDirectionIsConstantOnlyInOrthographicViews) {
  Frustum f;
  f.perspective = false;
  const Projection orthographic = projection_of(f);
  EXPECT_EQ(view_at(orthographic, vec2(700, 100)), vec3(0, 0, 1));
  f.perspective = true;
  const Projection perspective = projection_of(f);
  const vec2 pixel = pixel_of(perspective, vec3(3, 4, -5));
  EXPECT_LT(distance(view_at(perspective, pixel), normalize(vec3(-3, -4, 5))), 1e-6f);
}

TEST(Projection, NarrowPerspectiveFromAfarApproachesAnOrthographicView) {
  Frustum narrow;
  const double distance_away = 1e4;
  narrow.left = narrow.bottom = -1 / distance_away;
  narrow.right = narrow.top = 1 / distance_away;
  narrow.near = distance_away - 10;
  narrow.far = distance_away + 10;
  Frustum orthographic;
  orthographic.perspective = false;
  const Projection a = projection_of(narrow), b = projection_of(orthographic);
  const vec2 pixel = vec2(0.9f, 0.2f) * a.size_px;
  const vec3 from_a = position_at(a, pixel, float(distance_away));
  const vec3 from_b = position_at(b, pixel, 0.0f);
  EXPECT_NEAR(from_a.x, from_b.x, 1e-3f);
  EXPECT_NEAR(from_a.y, from_b.y, 1e-3f);
  EXPECT_LT(distance(view_at(a, pixel), view_at(b, pixel)), 2e-4f);
}

TEST(Projection, FirstRowOfTheImageIsTheTopOfTheViewUnlessTheProjectionIsFlipped) {
  const Projection p = projection_of(Frustum{});
  EXPECT_GT(position_at(p, vec2(480.0f, 0.0f), 1.0f).y, 0.9f);
  Frustum upside_down;
  upside_down.flipped = true;
  EXPECT_LT(position_at(projection_of(upside_down), vec2(480.0f, 0.0f), 1.0f).y, -0.9f);
}

// Elements that are zero in the exact matrix get random rounding errors, as products and inverses
// of matrices in floats have them.
TEST(MakeProjection, RoundingErrorsInZeroElementsOfTheMatrixAreAcceptedAndRemoved) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const Frustum f = random_frustum(random);
    const mat4 exact = matrix_of(f);
    mat4 rounded = exact;
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) {
        if (exact[column][row] != 0.0f) continue;
        const float scale = row == 3 && column == 3 ? std::abs(exact[3][2])
                            : row == 3              ? std::abs(exact[2][3]) + std::abs(exact[3][3])
                            : row == 2              ? std::abs(exact[2][2])
                                                    : std::abs(exact[row][row]);
        rounded[column][row] = random.uniform(-3e-7f, 3e-7f) * scale;
      }
    }
    // The depth of an orthographic view may span 1e6, over which w must stay 1.
    if (!f.perspective) rounded[2][3] = random.uniform(-1e-5f, 1e-5f) * std::abs(exact[2][2]);
    const auto accepted = maths::make_projection(rounded, 64, 64);
    ASSERT_TRUE(accepted.has_value()) << accepted.error() << ' ' << describe(f);
    const Projection expected = projection_of(f, 64, 64);
    EXPECT_EQ(accepted->perspective, expected.perspective) << describe(f);
    EXPECT_EQ(accepted->reversed, expected.reversed) << describe(f);
    // Both ends of a ray through the far corner of the image.
    for (const float depth : {0.0f, 1.0f}) {
      const vec3 corner = position_at(expected, expected.size_px, depth);
      EXPECT_LT(distance(position_at(*accepted, expected.size_px, depth), corner),
                1e-5f * (1.0f + length(corner)))
          << describe(f);
    }
  }
}

TEST(MakeProjection, InvalidProjectionMatricesAreRefusedWithAReason) {
  const mat4 good = matrix_of(Frustum{});
  const auto fault = [](const mat4& m) {
    const auto p = maths::make_projection(m, 16, 16);
    return p ? std::string() : std::string(p.error());
  };
  EXPECT_EQ(fault(good), "");
  struct Case {
    int column, row;
    float value;
    const char* why;
  };
  for (const Case& wrong :
       {Case{1, 2, kNan, "not finite"}, Case{0, 0, 0.0f, "flattens"},
        Case{0, 0, 1e-40f, "flattens"}, Case{1, 1, 1e38f, "stretches"},
        Case{0, 1, 0.5f, "mixes x and y"}, Case{0, 3, 0.5f, "tilts"}, Case{1, 2, 0.5f, "oblique"},
        Case{2, 3, 1.0f, "+Z"}, Case{3, 3, 0.5f, "eye along z"},
        Case{3, 0, 1e38f, "eye along x or y"}, Case{3, 1, 0.002f, "eye along x or y"},
        Case{2, 2, 1e-40f, "range of depth"}, Case{2, 2, 1e38f, "range of depth"},
        Case{3, 2, 0.0f, "range of depth"}, Case{3, 2, 1e-40f, "range of depth"},
        Case{3, 2, 1e38f, "range of depth"}}) {
    mat4 m = good;
    m[wrong.column][wrong.row] = wrong.value;
    EXPECT_NE(fault(m).find(wrong.why), std::string::npos) << wrong.why;
  }
  EXPECT_NE(fault(mat4(0.0f)), "");
  EXPECT_FALSE(maths::make_projection(good, 0, 16).has_value());
  EXPECT_FALSE(maths::make_projection(good, 16, 0).has_value());
}

}  // namespace
}  // namespace alcove::maths_test
