// Weights of the spatial filter, reprojection and accumulation.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "maths/filter_weights.h"
#include "maths/history.h"
#include "maths/make_projection.h"
#include "maths/reprojection.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;

maths::Projection perspective() {
  mat4 m(0.0f);
  m[0][0] = 1.0f;
  m[1][1] = -1.7f;
  m[2][2] = -1.0f;
  m[2][3] = -1.0f;
  m[3][2] = -0.1f;
  return maths::make_projection(m, 96, 54).value();
}

TEST(FilterWeights, APlaneAtAnyTiltWeighsOneThroughout) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec3 centre = random.unit_vector() * 10.0f, normal = random.unit_vector();
    const vec3 in_plane = cross(normal, random.unit_vector()) * random.uniform(0.0f, 5.0f);
    EXPECT_GT(maths::plane_weight(centre, normal, centre + in_plane, 0.01f), 0.999f);
    EXPECT_EQ(maths::plane_weight(centre, normal, centre + in_plane + normal * 0.02f, 0.01f), 0.0f);
  }
}

TEST(FilterWeights, FallFromOneToNothing) {
  const auto expect_falling = [](auto weight) {
    float before = weight(0.0f);
    EXPECT_FLOAT_EQ(before, 1.0f);
    for (float x = 0.0f; x <= 1.0f; x += 0.01f) {
      EXPECT_LE(weight(x), before + 1e-6f);
      EXPECT_GE(weight(x), 0.0f);
      before = weight(x);
    }
    EXPECT_NEAR(weight(1.0f), 0.0f, 1e-6f);
  };
  expect_falling(
      [](float x) { return maths::plane_weight(vec3(0), vec3(0, 0, 1), vec3(3, 4, x), 1.0f); });
  expect_falling([](float x) { return maths::slope_weight(5.0f + x, 5.0f, 1.0f); });
  expect_falling([](float x) {
    return maths::normal_weight(vec3(0, 0, 1), vec3(std::sin(x), 0, std::cos(x)), std::cos(1.0f));
  });
}

TEST(FilterWeights, SlopeIsTakenOnTheSideWithoutAnEdge) {
  EXPECT_FLOAT_EQ(maths::depth_slope(1.0f, 1.1f, 9.0f), 0.1f);
  EXPECT_FLOAT_EQ(maths::depth_slope(9.0f, 1.1f, 1.2f), 0.1f);
}

TEST(FilterWeights, ConvergedPixelsAreLeftAlone) {
  EXPECT_EQ(maths::filter_strength(1.0f, 16.0f), 1.0f);
  EXPECT_EQ(maths::filter_strength(16.0f, 16.0f), 0.0f);
  EXPECT_EQ(maths::filter_strength(99.0f, 16.0f), 0.0f);
  EXPECT_EQ(maths::filter_strength(1.0f, 1.0f), 0.0f);
}

TEST(Reprojection, ACameraThatStandsStillReturnsEveryPixelToItself) {
  const maths::Projection p = perspective();
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const vec2 uv(random.uniform(0, 1), random.uniform(0, 1));
    const float depth = random.log_uniform(0.2f, 1e5f);
    const maths::Reprojected r =
        maths::reproject_camera(p, mat4(1.0f), maths::position_vs(p, uv, depth));
    EXPECT_LT(distance(r.uv, uv), 1e-5f);
    EXPECT_FLOAT_EQ(r.depth, depth);
    EXPECT_EQ(r.valid, 1.0f);
  }
}

TEST(Reprojection, FollowsACameraThatMovedAndTurned) {
  const maths::Projection p = perspective();
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const mat4 to_previous =
        glm::translate(glm::rotate(mat4(1.0f), random.uniform(-0.3f, 0.3f), random.unit_vector()),
                       random.unit_vector());
    const vec2 uv(random.uniform(0, 1), random.uniform(0, 1));
    const vec3 position = maths::position_vs(p, uv, random.uniform(3.0f, 50.0f));
    const vec3 before(to_previous * glm::vec4(position, 1.0f));
    const maths::Reprojected r = maths::reproject_camera(p, to_previous, position);
    EXPECT_FLOAT_EQ(r.depth, -before.z);
    EXPECT_LT(distance(maths::position_vs(p, r.uv, r.depth), before), 1e-3f);
  }
}

TEST(Reprojection, PointsBehindTheEyeOrOffTheImageAreInvalidAndFinite) {
  const maths::Projection p = perspective();
  for (const float z : {0.0f, 1.0f, 1e7f}) {
    const maths::Reprojected r = maths::reproject_camera(p, mat4(1.0f), vec3(0.1f, 0.2f, z));
    EXPECT_EQ(r.valid, 0.0f);
    EXPECT_TRUE(std::isfinite(r.uv.x) && std::isfinite(r.uv.y));
  }
  EXPECT_EQ(maths::reproject_camera(p, mat4(1.0f), vec3(50, 0, -1)).valid, 0.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(maths::reproject_camera(p, mat4(1.0f), vec3(nan)).valid, 0.0f);
}

TEST(Reprojection, MotionVectorsDecideWhereThePointWas) {
  const maths::Projection p = perspective();
  const vec2 uv(0.5f, 0.5f);
  const maths::Reprojected r = maths::reproject_motion(
      p, mat4(1.0f), maths::position_vs(p, uv, 4.0f), uv, vec2(0.1f, -0.2f));
  EXPECT_FLOAT_EQ(r.uv.x, 0.4f);
  EXPECT_FLOAT_EQ(r.uv.y, 0.7f);
  EXPECT_EQ(r.valid, 1.0f);
}

TEST(Reprojection, BilinearTapsRebuildALinearImage) {
  RandomInput random;
  const vec2 size(37, 21);
  for (int i = 0; i < 1000; ++i) {
    const vec2 uv(random.uniform(0, 1), random.uniform(0, 1));
    const maths::BilinearTaps taps = maths::bilinear_taps(uv, size);
    const auto image = [](float x, float y) { return 3.0f * (x + 0.5f) - 2.0f * (y + 0.5f); };
    const float x = taps.first.x, y = taps.first.y;
    const float value = taps.weights.x * image(x, y) + taps.weights.y * image(x + 1, y) +
                        taps.weights.z * image(x, y + 1) + taps.weights.w * image(x + 1, y + 1);
    EXPECT_NEAR(value, 3.0f * uv.x * size.x - 2.0f * uv.y * size.y, 1e-3f);
  }
}

TEST(History, DepthThatDiffersIsRejectedAndSlantedDepthGivenRoom) {
  EXPECT_EQ(maths::history_weight(10.0f, 10.0f, 0.02f, 1.0f), 1.0f);
  EXPECT_EQ(maths::history_weight(10.0f, 10.3f, 0.02f, 1.0f), 0.0f);
  EXPECT_GT(maths::history_weight(10.0f, 10.3f, 0.02f, 0.2f), 0.5f);
  EXPECT_EQ(maths::history_weight(10.0f, maths::kSkyDepth, 0.02f, 0.0f), 0.0f);
  EXPECT_TRUE(std::isfinite(maths::history_weight(0.0f, 0.0f, 0.02f, 0.0f)));
}

TEST(History, EqualFramesWeighTheSameUntilTheLongest) {
  RandomInput random;
  float history = 0.0f, count = 0.0f;
  double sum = 0.0;
  for (int frame = 1; frame <= 32; ++frame) {
    const float now = random.uniform(0, 1);
    sum += now;
    history = maths::accumulate(history, now, maths::accumulation_weight(count, 64.0f));
    count = maths::next_count(count, 64.0f);
    EXPECT_NEAR(history, sum / frame, 1e-5);
  }
}

TEST(History, NeverDriftsOrLocksOverAMillionFrames) {
  float history = 0.0f, count = 0.0f;
  for (int frame = 0; frame < 1000000; ++frame) {
    history = maths::accumulate(history, 0.7f, maths::accumulation_weight(count, 32.0f));
    count = maths::next_count(count, 32.0f);
  }
  EXPECT_NEAR(history, 0.7f, 1e-6f);
  EXPECT_EQ(count, 32.0f);
  for (int frame = 0; frame < 400; ++frame)
    history = maths::accumulate(history, 0.2f, maths::accumulation_weight(count, 32.0f));
  EXPECT_NEAR(history, 0.2f, 1e-5f);
}

TEST(History, FirstFrameStandsAloneAndBrokenHistoryIsForgotten) {
  EXPECT_EQ(maths::accumulate(99.0f, 0.3f, maths::accumulation_weight(0.0f, 32.0f)), 0.3f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(maths::accumulate(nan, 0.3f, 0.1f), 0.3f);
}

TEST(History, SpreadIsMeanAndDeviation) {
  const maths::Spread s = maths::spread_of_sums(1.0f + 2.0f + 3.0f, 1.0f + 4.0f + 9.0f, 3.0f);
  EXPECT_FLOAT_EQ(s.mean, 2.0f);
  EXPECT_NEAR(s.deviation, std::sqrt(2.0f / 3.0f), 1e-6f);
  EXPECT_EQ(maths::spread_of_sums(0.0f, 0.0f, 0.0f).deviation, 0.0f);
  EXPECT_GE(maths::spread_of_sums(9 * 0.1f, 9 * 0.01f - 1e-6f, 9.0f).deviation, 0.0f);
}

TEST(History, ClampKeepsWhatAgreesAndCountForgetsWhatMoved) {
  maths::Spread now;
  now.mean = 0.5f;
  now.deviation = 0.1f;
  EXPECT_EQ(maths::clamp_to_spread(0.55f, now, 1.0f), 0.55f);
  EXPECT_FLOAT_EQ(maths::clamp_to_spread(0.9f, now, 1.0f), 0.6f);
  EXPECT_EQ(maths::count_after_clamp(20.0f, 0.55f, 0.55f, 0.2f), 20.0f);
  EXPECT_EQ(maths::count_after_clamp(20.0f, 0.9f, 0.6f, 0.2f), 1.0f);
  EXPECT_FLOAT_EQ(maths::count_after_clamp(21.0f, 0.7f, 0.6f, 0.2f), 11.0f);
}

TEST(History, StateKeepsWhatItHolds) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float depth = std::exp(random.uniform(-7.0f, 11.0f));
    const float count = std::floor(random.uniform(0.0f, 255.99f));
    const float recent = random.uniform(0.0f, 1.0f);
    const maths::HistoryState state =
        maths::unpack_history_state(maths::pack_history_state(depth, count, recent));
    EXPECT_NEAR(state.depth, depth, depth * std::ldexp(1.0f, -11));
    EXPECT_EQ(state.count, count);
    EXPECT_NEAR(state.recent, recent, 0.5f / 255.0f + 1e-6f);
  }
  const maths::HistoryState least =
      maths::unpack_history_state(maths::pack_history_state(0.0f, -1.0f, -1.0f));
  EXPECT_EQ(least.count + least.recent + least.depth, 0.0f);
  const maths::HistoryState most =
      maths::unpack_history_state(maths::pack_history_state(1.0f, 300.0f, 2.0f));
  EXPECT_EQ(most.count, 255.0f);
  EXPECT_EQ(most.recent, 1.0f);
}

TEST(History, ChangeIsToldFromTheNoiseOfAFewSearches) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float a = random.uniform(0.0f, 1.0f);
    const float b = random.uniform(0.0f, 1.0f);
    EXPECT_EQ(maths::visibility_changed(a, a), 0.0f);
    const float changed = maths::visibility_changed(a, b);
    EXPECT_GE(changed, 0.0f);
    EXPECT_LE(changed, 1.0f);
    EXPECT_EQ(changed, maths::visibility_changed(b, a));
  }
  // There is no noise in the open, where a trail is seen at once.
  EXPECT_EQ(maths::visibility_changed(0.8f, 1.0f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(1.0f, 0.8f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(0.55f, 0.45f), 0.0f);
  EXPECT_EQ(maths::visibility_changed(0.2f, 0.8f), 1.0f);
}

TEST(History, RecentIsAMeanThatForgetsInAFewFrames) {
  EXPECT_EQ(maths::recent_visibility(0.3f, 0.0f, 0.9f), 0.9f);
  EXPECT_FLOAT_EQ(maths::recent_visibility(0.2f, 1.0f, 0.4f), 0.3f);
  float recent = 0.0f;
  for (int frame = 0; frame < 12; ++frame) recent = maths::recent_visibility(recent, 32.0f, 1.0f);
  EXPECT_GT(recent, 0.95f);
}

}  // namespace
}  // namespace alcove::maths_test
