#include <gmock/gmock.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "drawing.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

class NormalsFromDepth : public PassTest {
 protected:
  HostImage normals(const AlcoveCamera& view, const HostImage& depth_ndc) {
    run([&](Graph& graph) {
      const auto surface = add_surface(graph, gpu().pipelines(), view, upload(graph, depth_ndc));
      ASSERT_TRUE(surface) << surface.error().message;
      read_back(graph, surface->normals);
    });
    return result();
  }
};

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

TEST_F(NormalsFromDepth, PlanesGetTheirExactNormalAtAnyTiltUpToTheImageBorder) {
  for (const TestView& view : test_views()) {
    for (const double tilt : {0.0, 30.0, 60.0, 80.0}) {
      SCOPED_TRACE(testing::Message() << view.name << " tilted " << tilt << " degrees");
      const Drawing drawing = draw(view, 41, 27, {tilted_plane(tilt, 4.0)});
      // A 32-bit raw depth determines the distance with a relative error of 1e-6.
      EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
    }
  }
}

TEST_F(NormalsFromDepth, NormalsAreNotBlurredAcrossADepthStep) {
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

TEST_F(NormalsFromDepth, NormalsAreNotBlurredAcrossACrease) {
  const TestView view = test_views()[5];
  Shape left = plane({0.0, 0.0, -5.0}, {1.0, 0.0, 1.0});
  left.keep = [](const glm::dvec3& p) { return p.x < 0.0; };
  Shape right = plane({0.0, 0.0, -5.0}, {-1.0, 0.0, 1.0});
  right.keep = [](const glm::dvec3& p) { return p.x >= 0.0; };
  const Drawing drawing = draw(view, 60, 40, {left, right});
  EXPECT_LT(largest_error(normals(view.view, drawing.depth_ndc), drawing), 0.5);
}

TEST_F(NormalsFromDepth, NormalOfTheSkyFacesTheEyeAndSkyDoesNotAffectNeighbouringNormals) {
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

TEST_F(NormalsFromDepth, SurfaceTwoPixelsWideGetsItsOwnNormal) {
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

TEST_F(NormalsFromDepth, PixelWithNaNDepthAffectsNoOtherNormal) {
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

TEST_F(NormalsFromDepth, ImagesOfOneRowOrColumnGetNormalsOfUnitLength) {
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
