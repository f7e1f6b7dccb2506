#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "drawing.h"
#include "maths/constants.h"
#include "pass_fixture.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

class SurfacePass : public PassTest {
 protected:
  // Runs add_surface() on a depth buffer that the view's projection wrote. `which` is the texture
  // that is read back.
  const HostImage& surface(const AlcoveCamera& view, const HostImage& depth_ndc,
                           framegraph::Texture SurfaceTextures::*which) {
    run([&](Graph& graph) {
      const auto textures = add_surface(graph, gpu().pipelines(), view, upload(graph, depth_ndc));
      ASSERT_TRUE(textures) << textures.error().message;
      read_back(graph, (*textures).*which);
    });
    return result();
  }
  HostImage linear_image(const AlcoveCamera& view, const HostImage& depth_ndc) {
    return surface(view, depth_ndc, &SurfaceTextures::linear_depth);
  }
  HostImage normals(const AlcoveCamera& view, const HostImage& depth_ndc) {
    return surface(view, depth_ndc, &SurfaceTextures::normals);
  }
};

glm::dmat4 clip_from_view(const TestView& view) {
  glm::mat4 single;
  std::memcpy(&single[0][0], view.view.clip_from_view, sizeof(single));
  return glm::dmat4(single);
}

// Returns the linear depth by inverting the projection matrix, which is not the shader's formula.
double linear_depth(const glm::dmat4& projection, float depth_ndc) {
  const glm::dvec4 point = glm::inverse(projection) * glm::dvec4(0.0, 0.0, depth_ndc, 1.0);
  return -point.z / point.w;
}

bool is_reversed(const glm::dmat4& m) { return m[2][2] * m[3][3] > m[3][2] * m[2][3]; }

TEST_F(SurfacePass, LinearDepthEqualsTheInverseProjectionOfRawDepthForEveryKindOfProjection) {
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

TEST_F(SurfacePass, RawDepthsOutOfRangeBecomeTheSkyOrTheNearPlaneAndNaNBecomesTheSky) {
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

TEST_F(SurfacePass, EveryPixelIsWrittenAtAnyImageSize) {
  const TestView view = test_views()[2];
  const double expected = linear_depth(clip_from_view(view), 0.5f);
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {3u, 5u}, {17u, 9u}, {33u, 1u}, {1u, 40u}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    poison_memory(width, height);
    const HostImage depth{width, height, std::vector<float>(std::size_t{width} * height, 0.5f), 1};
    EXPECT_THAT(linear_image(view.view, depth).texels,
                testing::Each(testing::FloatNear(static_cast<float>(expected), 1e-4f)));
  }
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

glm::dvec3 vector_at(const HostImage& image, std::uint32_t x, std::uint32_t y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

// Returns whether the pixel has, on each axis, at least one neighbour that is not sky.
bool has_neighbours(const Drawing& drawing, std::uint32_t x, std::uint32_t y) {
  const auto seen = [&](std::uint32_t column, std::uint32_t row) {
    return column < drawing.depth_ndc.width && row < drawing.depth_ndc.height &&
           !drawing.is_sky(column, row);
  };
  return (seen(x - 1, y) || seen(x + 1, y)) && (seen(x, y - 1) || seen(x, y + 1));
}

// Returns the largest angle in degrees between computed and drawn normals, including border pixels
// and excluding the sky.
double largest_error(const HostImage& normals, const Drawing& drawing) {
  double largest = 0.0;
  for (std::uint32_t y = 0; y < normals.height; ++y) {
    for (std::uint32_t x = 0; x < normals.width; ++x) {
      if (drawing.is_sky(x, y)) continue;
      const glm::dvec3 normal = vector_at(normals, x, y);
      EXPECT_NEAR(glm::length(normal), 1.0, 2e-3);
      if (!has_neighbours(drawing, x, y) && drawing.depth_ndc.texels.size() > 20) continue;
      largest = std::max(largest, angle_between(normal, vector_at(drawing.normal_vs, x, y)));
    }
  }
  return largest;
}

TEST_F(SurfacePass, PlanesGetTheirExactNormalAtAnyTiltUpToTheImageBorder) {
  for (const TestView& view : test_views()) {
    for (const double tilt : {0.0, 30.0, 60.0, 80.0}) {
      SCOPED_TRACE(testing::Message() << view.name << " tilted " << tilt << " degrees");
      const Drawing drawing = draw(view, 41, 27, {tilted_plane(tilt, 4.0)});
      // A 32-bit raw depth determines the distance with a relative error of 1e-6.
      EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
    }
  }
}

TEST_F(SurfacePass, NormalsAreNotBlurredAcrossADepthStep) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    // The front of a box in front of a wall. Both face the eye, and their depths differ by at least
    // half a unit.
    Shape front = plane({0.0, 0.0, -3.4}, {0.0, 0.2, 1.0});
    front.keep = [](const glm::dvec3& p) { return p.x > -0.9 && p.x < 0.7 && p.y < 0.5; };
    const Drawing drawing = draw(view, 60, 40, {front, tilted_plane(20.0, 4.5)});
    EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
  }
}

TEST_F(SurfacePass, NormalsAreNotBlurredAcrossACrease) {
  const TestView view = test_views()[5];
  Shape left = plane({0.0, 0.0, -5.0}, {1.0, 0.0, 1.0});
  left.keep = [](const glm::dvec3& p) { return p.x < 0.0; };
  Shape right = plane({0.0, 0.0, -5.0}, {-1.0, 0.0, 1.0});
  right.keep = [](const glm::dvec3& p) { return p.x >= 0.0; };
  const Drawing drawing = draw(view, 60, 40, {left, right});
  EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
}

TEST_F(SurfacePass, NormalOfTheSkyFacesTheEyeAndSkyDoesNotAffectNeighbouringNormals) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    Shape post = plane({0.0, 0.0, -4.0}, {0.3, 0.0, 1.0});
    post.keep = [](const glm::dvec3& p) { return std::abs(p.x) < 0.8; };
    const Drawing drawing = draw(view, 45, 31, {post});
    const HostImage image = normals(view.view, drawing.depth_ndc);
    EXPECT_LT(largest_error(image, drawing), 0.5);
    for (std::uint32_t y = 0; y < 31; ++y) {
      for (std::uint32_t x = 0; x < 45; ++x)
        if (drawing.is_sky(x, y)) {
          ASSERT_LT(angle_between(vector_at(image, x, y), drawing.camera.to_eye(x, y)), 0.1);
        }
    }
  }
}

TEST_F(SurfacePass, SurfaceTwoPixelsWideGetsItsOwnNormal) {
  for (const TestView& view : test_views()) {
    for (const double n_dot_v : {-0.5, 0.5}) {
      SCOPED_TRACE(testing::Message() << view.name << ", n.v " << n_dot_v);
      const Drawing wide = draw(view, 40, 30, {plane({0.0, 0.0, -3.0}, {n_dot_v, 0.1, 1.0})});
      Shape strip = wide.scene[0];
      strip.keep = [&](const glm::dvec3& position) {
        const double column = wide.camera.project(position).x;
        return column > 19.0 && column < 21.0;
      };
      for (const Scene& scene : {Scene{strip}, Scene{strip, tilted_plane(10.0, 9.0)}}) {
        const Drawing drawing = draw(view, 40, 30, scene);
        EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
      }
    }
  }
}

TEST_F(SurfacePass, PixelWithNaNDepthAffectsNoOtherNormal) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    Drawing drawing = draw(view, 40, 30, {tilted_plane(50.0, 4.0)});
    for (const std::size_t pixel : {0u, 15u * 40u + 20u, 29u * 40u + 39u, 29u * 40u + 20u})
      drawing.depth_ndc.texels[pixel] = kNaN;
    const HostImage image = normals(view.view, drawing.depth_ndc);
    EXPECT_LT(largest_error(image, drawing), 0.5);
    for (const float component : image.texels) ASSERT_TRUE(std::isfinite(component));
  }
}

TEST_F(SurfacePass, ImagesOfOneRowOrColumnGetNormalsOfUnitLength) {
  const TestView view = test_views()[2];
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 9u}, {9u, 1u}, {2u, 2u}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    poison_memory(width, height);
    const Drawing drawing = draw(view, width, height, {tilted_plane(0.0, 4.0)});
    EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
  }
}

}  // namespace
}  // namespace alcove::passes
