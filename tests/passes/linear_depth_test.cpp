#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "maths/projection.h"
#include "pass_fixture.h"
#include "views.h"
#include "work/rigid_transform.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

glm::dmat4 clip_from_view(const TestView& view) {
  return glm::dmat4(to_mat4(view.view.clip_from_view));
}

// Returns the linear depth by inverting the projection matrix, which is not the shader's formula.
double linear_depth(const glm::dmat4& projection, float depth_ndc) {
  const glm::dvec4 point = glm::inverse(projection) * glm::dvec4(0.0, 0.0, depth_ndc, 1.0);
  return -point.z / point.w;
}

bool is_reversed(const glm::dmat4& m) { return m[2][2] * m[3][3] > m[3][2] * m[2][3]; }

class LinearDepth : public PassTest {
 protected:
  // Linear depth of `depth`, a depth buffer that the view's projection wrote.
  HostImage linear_image(const AlcoveCamera& view, const HostImage& depth) {
    run([&](Graph& graph) {
      const auto surface = add_surface(graph, gpu().pipelines(), view, upload(graph, depth));
      ASSERT_TRUE(surface) << surface.error().message;
      read_back(graph, surface->linear_depth);
    });
    return result();
  }
};

TEST_F(LinearDepth, LinearDepthEqualsTheInverseProjectionOfRawDepthForEveryKindOfProjection) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const glm::dmat4 projection = clip_from_view(view);
    const bool reversed = is_reversed(projection);
    // Raw depths from the near plane nearly to the far plane, in smaller steps towards the far
    // plane.
    HostImage depth{33, 5, {}, 1};
    for (int i = 0; i < 33 * 5; ++i) {
      const float away = std::pow(0.94f, static_cast<float>(i));
      depth.texels.push_back(reversed ? away : 1.0f - away);
    }
    const HostImage linear = linear_image(view.view, depth);
    for (std::size_t i = 0; i < depth.texels.size(); ++i) {
      const double expected = linear_depth(projection, depth.texels[i]);
      // A raw depth near 1 determines the distance with few digits. An error of half its last digit
      // is allowed.
      const double digit = 6e-8 * std::max(std::abs(depth.texels[i]), 1e-30f);
      const double slack =
          std::abs(linear_depth(projection, depth.texels[i] - static_cast<float>(digit)) -
                   expected) +
          2e-6 * std::abs(expected);
      ASSERT_NEAR(linear.texels[i], expected, slack) << "of raw depth " << depth.texels[i];
    }
  }
}

TEST_F(LinearDepth, RawDepthsOutOfRangeBecomeTheSkyOrTheNearPlaneAndNaNBecomesTheSky) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const glm::dmat4 projection = clip_from_view(view);
    const bool reversed = is_reversed(projection);
    const float far = reversed ? 0.0f : 1.0f;
    const float beyond_far = reversed ? -kInfinity : kInfinity;
    const float before_near = reversed ? 7.0f : -7.0f;
    const HostImage depth{
        6, 1, {far, kNaN, beyond_far, reversed ? -0.5f : 1.5f, before_near, -beyond_far}, 1};
    const HostImage linear = linear_image(view.view, depth);
    const double near = linear_depth(projection, 1.0f - far);
    EXPECT_THAT(std::vector(linear.texels.begin(), linear.texels.begin() + 4),
                testing::Each(maths::kSkyDepth));
    EXPECT_NEAR(linear.texels[4], near, 1e-5 * near);
    EXPECT_NEAR(linear.texels[5], near, 1e-5 * near);
  }
}

TEST_F(LinearDepth, EveryPixelIsWrittenAtAnyImageSize) {
  const TestView view = test_views()[2];
  const double expected = linear_depth(clip_from_view(view), 0.5f);
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {3u, 5u}, {17u, 9u}, {33u, 1u}, {1u, 40u}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    poison_memory(width, height);
    EXPECT_THAT(linear_image(view.view, uniform(width, height, {0.5f})).texels,
                testing::Each(testing::FloatNear(static_cast<float>(expected), 1e-4f)));
  }
}

}  // namespace
}  // namespace alcove::passes
