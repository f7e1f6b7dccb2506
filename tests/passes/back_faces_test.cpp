// Compares visibility with closed forms, for occluders whose thickness comes from a depth buffer of
// back faces.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hidden_depths.h"

namespace alcove::passes {
namespace {

class BackFaceDepth : public HiddenDepthTest {};

OcclusionSettings exact(float radius) {
  OcclusionSettings settings = without_hidden_occlusion(radius);
  settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  return settings;
}

OcclusionSettings of_thickness(OcclusionSettings settings, float thickness) {
  settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_RADIUS;
  settings.thickness = thickness;
  return settings;
}

//            ____
//           |____|   a slab, endless along y: from a point of the floor it occludes the angles
//        .´ .´       between the directions to its near upper edge and to its far lower edge
//   ____x_____________
TEST_F(BackFaceDepth, VisibilityUnderASlabWithBackFaceDepthMatchesTheClosedForm) {
  const TestView view = orthographic_view("orthographic", 4.0, 4.0, 0.1, 20.0);
  const double near = 0.3, far = 0.7, bottom = 0.8, top = 1.0, floor = 4.0;
  Scene scene = box({near, -100.0, bottom - floor}, {far, 100.0, top - floor});
  scene.push_back(plane({0.0, 0.0, -floor}, {0.0, 0.0, 1.0}));
  const Drawing drawing = draw(view, 128, 128, scene);
  const HostImage backs = draw_back_faces(view, 128, 128, scene);
  const auto mean_error = [&](const OcclusionSettings& settings) {
    const HostImage image = visibility(drawing, backs, settings);
    double sum = 0.0;
    for (std::uint32_t x = 44; x < 66; ++x) {
      const double at = (x + 0.5 - 64) * 8.0 / 128;
      const double truth = 1.0 - 0.5 * ((far - at) / std::hypot(far - at, bottom) -
                                        (near - at) / std::hypot(near - at, top));
      sum += std::abs(image.at(x, 64) - truth) / 22;
    }
    return sum;
  };
  const OcclusionSettings settings = exact(8.0f);
  const double error = mean_error(settings);
  EXPECT_LT(error, 0.02);
  // The visible width limits the thickness, so that a large setting does no harm.
  EXPECT_LT(2.0 * error, mean_error(of_thickness(settings, 1e-3f)))
      << "with a setting far below the actual thickness";
}

// A ball with radius r, whose centre is at distance d and at angle t to the normal, lowers the
// visibility by cos t (r / d)^2 if it lies completely above the tangent plane.
TEST_F(BackFaceDepth, VisibilityUnderABallWithBackFaceDepthMatchesTheClosedFormInEveryView) {
  // Every image shows all of the floor within the radius of a tested point, so that no direction is
  // excluded.
  const glm::dvec3 centre(0.05, -0.1, -3.46);
  const double radius = 0.21, floor = 4.0;
  const Scene scene{plane({0.0, 0.0, -floor}, {0.0, 0.0, 1.0}), sphere(centre, radius)};
  for (const TestView& view : test_views()) {
    const Drawing drawing = draw(view, 108, 72, scene);
    const HostImage backs = draw_back_faces(view, 108, 72, scene);
    const auto mean_error = [&](const OcclusionSettings& settings) {
      const HostImage image = visibility(drawing, backs, settings);
      double sum = 0.0;
      int count = 0;
      for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
          const auto hit = cast(scene, drawing.camera.ray(x + 0.5, y + 0.5));
          const glm::dvec3 away = centre - hit->position;
          const double distance = glm::length(away);
          if (hit->position.z < -floor + 1e-6 && distance < 0.96) {
            const double truth = 1.0 - away.z / distance * radius * radius / (distance * distance);
            sum += std::abs(image.at(x, y) - truth);
            ++count;
          }
        }
      }
      return sum / count;
    };
    EXPECT_LT(mean_error(exact(1.2f)), 0.01) << view.name;
  }
}

TEST_F(BackFaceDepth, SolidThickerThanTheRadiusOccludesAtMostLikeAnInfinitelyThickOne) {
  const float radius = 1.2f;
  Scene scene = box({0.31, -50.0, -20.0}, {50.0, 50.0, -3.5});
  scene.push_back(plane({0.0, 0.0, -4.0}, {0.0, 0.0, 1.0}));
  for (const TestView& view : {test_views()[2], orthographic_view("", 3.0, 2.0, 0.1, 50.0)}) {
    SCOPED_TRACE(view.name);
    const Drawing drawing = draw(view, 60, 40, scene);
    const HostImage backs = draw_back_faces(view, 60, 40, scene);
    const OcclusionSettings settings = exact(radius);
    const HostImage image = visibility(drawing, backs, settings);
    const HostImage thick = visibility(drawing, backs, of_thickness(settings, 1e4f));
    // If the thickness comes from the setting, the occluder is assumed to be thin at its leading
    // edge, so that it occludes less than with back faces.
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      EXPECT_LT(image.texels[i], thick.texels[i] + 1e-5);
  }
}

// Tests back-face depths that give no thickness: the far plane (sky), the near plane (in front of
// the first layer), NaN, and the depth of the first layer itself, as if the visible surface were a
// back face.
TEST_F(BackFaceDepth, ThicknessSettingIsUsedWhereNoBackFaceLiesBehindTheVisibleSurface) {
  Scene scene = box({0.31, -50.0, -20.0}, {0.6, 50.0, -3.5});
  scene.push_back(plane({0.0, 0.0, -4.0}, {0.3, 0.1, 1.0}));
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const Drawing drawing = draw(view, 60, 40, scene);
    OcclusionSettings settings = exact(1.2f);
    settings.thickness = 0.2f;
    const HostImage expected = visibility(drawing, drawing.depth_ndc, of_thickness(settings, 0.2f));
    HostImage backs = drawing.depth_ndc;
    EXPECT_EQ(visibility(drawing, backs, settings).texels, expected.texels);
    const float sky = drawing.camera.sky();
    for (const float none : {sky, 1.0f - sky, std::numeric_limits<float>::quiet_NaN()}) {
      std::ranges::fill(backs.texels, none);
      EXPECT_EQ(visibility(drawing, backs, settings).texels, expected.texels) << none;
    }
  }
}

}  // namespace
}  // namespace alcove::passes
