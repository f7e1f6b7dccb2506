#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "maths/pyramid.h"
#include "pass_fixture.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

glm::dmat4 clip_from_view(const TestView& view) {
  glm::mat4 single;
  std::memcpy(&single[0][0], view.view.clip_from_view.data(), sizeof(single));
  return glm::dmat4(single);
}

// Depth as the projection's own inverse gives it: no formula of the shader's.
double linear_depth(const glm::dmat4& projection, float depth_ndc) {
  const glm::dvec4 point = glm::inverse(projection) * glm::dvec4(0.0, 0.0, depth_ndc, 1.0);
  return -point.z / point.w;
}

bool is_reversed(const glm::dmat4& m) { return m[2][2] * m[3][3] > m[3][2] * m[2][3]; }

class LinearDepth : public PassTest {
 protected:
  // Mips 0, 1... of a depth image.
  std::vector<HostImage> pyramid(const View& view, const HostImage& depth, std::uint32_t mips,
                                 float reach) {
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), view, 0};
      const auto linear = add_linear_depth(frame, upload(graph, depth), mips, reach);
      ASSERT_TRUE(linear) << linear.error().message;
      for (std::uint32_t mip = 0; mip < mips; ++mip) {
        read_back(graph, *linear, mip);
      }
    });
    std::vector<HostImage> images;
    for (std::uint32_t mip = 0; mip < mips; ++mip) {
      images.push_back(result(mip));
    }
    return images;
  }
};

TEST_F(LinearDepth, EqualsTheInverseProjectionForEveryKindOfProjection) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const glm::dmat4 projection = clip_from_view(view);
    const bool reversed = is_reversed(projection);
    // Raw depths from the near plane to close to the far one, finer towards the far side.
    HostImage depth{33, 5, {}, 1};
    for (int i = 0; i < 33 * 5; ++i) {
      const float away = std::pow(0.94f, static_cast<float>(i));
      depth.texels.push_back(reversed ? away : 1.0f - away);
    }
    const HostImage linear = pyramid(view.view, depth, 1, 1.0f)[0];
    for (std::size_t i = 0; i < depth.texels.size(); ++i) {
      const double expected = linear_depth(projection, depth.texels[i]);
      // A raw depth near 1 holds few digits of the distance: half of its last one is forgiven.
      const double digit = 6e-8 * std::max(std::abs(depth.texels[i]), 1e-30f);
      const double slack =
          std::abs(linear_depth(projection, depth.texels[i] - static_cast<float>(digit)) -
                   expected) +
          2e-6 * std::abs(expected);
      ASSERT_NEAR(linear.texels[i], expected, slack) << "of raw depth " << depth.texels[i];
    }
  }
}

TEST_F(LinearDepth, InvalidDepthsBecomeSkyOrTheNearPlane) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const glm::dmat4 projection = clip_from_view(view);
    const bool reversed = is_reversed(projection);
    const float far = reversed ? 0.0f : 1.0f;
    const float beyond_far = reversed ? -kInfinity : kInfinity;
    const float before_near = reversed ? 7.0f : -7.0f;
    const HostImage depth{
        6, 1, {far, kNaN, beyond_far, reversed ? -0.5f : 1.5f, before_near, -beyond_far}, 1};
    const HostImage linear = pyramid(view.view, depth, 1, 1.0f)[0];
    const double near = linear_depth(projection, 1.0f - far);
    EXPECT_THAT(std::vector(linear.texels.begin(), linear.texels.begin() + 4),
                testing::Each(maths::kSkyDepth));
    EXPECT_NEAR(linear.texels[4], near, 1e-5 * near);
    EXPECT_NEAR(linear.texels[5], near, 1e-5 * near);
  }
}

// Mips 0 to 4 on the CPU, of the image continued by its last row and column; sizes rounded down, as
// Vulkan's mips are.
std::vector<HostImage> reference_pyramid(const HostImage& depth, float reach) {
  HostImage whole{(depth.width + 15) / 16 * 16, (depth.height + 15) / 16 * 16, {}, 1};
  for (std::uint32_t y = 0; y < whole.height; ++y) {
    for (std::uint32_t x = 0; x < whole.width; ++x) {
      whole.texels.push_back(depth.at(std::min(x, depth.width - 1), std::min(y, depth.height - 1)));
    }
  }
  std::vector<HostImage> mips{depth};
  for (std::uint32_t mip = 1; mip < 5; ++mip) {
    HostImage next{whole.width / 2, whole.height / 2, {}, 1};
    for (std::uint32_t y = 0; y < next.height; ++y) {
      for (std::uint32_t x = 0; x < next.width; ++x) {
        const maths::vec4 four(whole.at(2 * x, 2 * y), whole.at(2 * x + 1, 2 * y),
                               whole.at(2 * x, 2 * y + 1), whole.at(2 * x + 1, 2 * y + 1));
        next.texels.push_back(maths::average_depth(four, reach));
      }
    }
    HostImage cut{std::max(depth.width >> mip, 1u), std::max(depth.height >> mip, 1u), {}, 1};
    for (std::uint32_t y = 0; y < cut.height; ++y) {
      for (std::uint32_t x = 0; x < cut.width; ++x) {
        cut.texels.push_back(next.at(x, y));
      }
    }
    mips.push_back(std::move(cut));
    whole = std::move(next);
    reach *= 2.0f;
  }
  return mips;
}

TEST_F(LinearDepth, MipsAverageTheMipAboveAtEverySize) {
  struct Size {
    std::uint32_t width;
    std::uint32_t height;
    std::uint32_t mips;
  };
  const TestView view = test_views()[2];
  const glm::dmat4 projection = clip_from_view(view);
  const std::uint32_t seed = 20;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (const Size size : {Size{1, 1, 1}, Size{3, 5, 3}, Size{17, 9, 5}, Size{33, 1, 5},
                          Size{1, 40, 5}, Size{61, 35, 5}, Size{241, 135, 5}}) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    poison_memory(size.width, size.height);
    HostImage depth{size.width, size.height, {}, 1};
    std::uniform_real_distribution<float> distance(2.0f, 3.0f);
    for (std::uint32_t i = 0; i < size.width * size.height; ++i) {
      const bool sky = random() % 16 == 0;
      const glm::dvec4 clip = projection * glm::dvec4(0.0, 0.0, -distance(random), 1.0);
      depth.texels.push_back(sky ? 0.0f : static_cast<float>(clip.z / clip.w));
    }
    const float reach = 0.4f;
    const std::vector<HostImage> mips = pyramid(view.view, depth, size.mips, reach);
    const std::vector<HostImage> expected = reference_pyramid(mips[0], reach);
    for (std::uint32_t mip = 1; mip < size.mips; ++mip) {
      SCOPED_TRACE(testing::Message() << "mip " << mip);
      ASSERT_EQ(expected[mip].texels.size(), mips[mip].texels.size());
      for (std::size_t i = 0; i < mips[mip].texels.size(); ++i) {
        const float texel = expected[mip].texels[i];
        ASSERT_NEAR(mips[mip].texels[i], texel, 1e-5f * texel) << "texel " << i;
      }
    }
  }
}

TEST_F(LinearDepth, MipCountIsLimitedByTheImageSize) {
  const TestView view = test_views()[0];
  for (const std::uint32_t wanted : {1u, 3u, 5u}) {
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), view.view, 0};
      const auto depth = upload(graph, {3, 5, std::vector<float>(15, 0.5f), 1});
      const auto linear = add_linear_depth(frame, depth, wanted, 1.0f);
      ASSERT_TRUE(linear) << linear.error().message;
      EXPECT_EQ(graph.description().resources[linear->index].mips, std::min(wanted, 3u));
      read_back(graph, *linear);
    });
  }
}

}  // namespace
}  // namespace alcove::passes
