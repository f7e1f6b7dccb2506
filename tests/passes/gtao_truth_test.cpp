// The occlusion of drawn scenes against brute force on the exact surfaces, and against closed
// forms.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtao_scenes.h"
#include "pass_fixture.h"
#include "reference_occlusion.h"

namespace alcove::passes {
namespace {

using GtaoTruth = PassTest;

// What compares with horizons of infinite thickness, whatever the estimator.
OcclusionSettings exact(Estimator estimator, float radius) {
  OcclusionSettings settings = quality_settings(Quality::reference, radius);
  settings.estimator = estimator;
  settings.fill = 1.0f;
  return settings;
}

const char* name_of(Estimator estimator) {
  return estimator == Estimator::bitmask ? "bitmask" : "horizons";
}

struct Errors {
  double mean = 0.0;
  double largest = 0.0;
};

// Over every 5th pixel of every 3rd row.
Errors errors_of(const HostImage& visibility, const Drawing& drawing, double radius) {
  Errors errors;
  int count = 0;
  for (std::uint32_t y = 1; y < visibility.height; y += 3) {
    for (std::uint32_t x = 2; x < visibility.width; x += 5) {
      if (!drawing.is_sky(x, y)) {
        const double truth = reference_occlusion(drawing, x, y, radius).visibility;
        const double error = std::abs(visibility.at(x, y) - truth);
        errors.mean += error;
        errors.largest = std::max(errors.largest, error);
        ++count;
      }
    }
  }
  errors.mean /= count;
  return errors;
}

// In degrees, over every 7th pixel of every 4th row.
double mean_bent_error(const HostImage& bent, const Drawing& drawing, double radius) {
  double sum = 0.0;
  int count = 0;
  for (std::uint32_t y = 1; y < bent.height; y += 4) {
    for (std::uint32_t x = 3; x < bent.width; x += 7) {
      const glm::dvec3 found(bent.at(x, y, 0), bent.at(x, y, 1), bent.at(x, y, 2));
      EXPECT_NEAR(glm::length(found), 1.0, 1e-3);
      const glm::dvec3 truth = reference_occlusion(drawing, x, y, radius).bent_normal;
      sum += std::atan2(glm::length(glm::cross(found, truth)), glm::dot(found, truth));
      ++count;
    }
  }
  return sum / count * 180.0 / std::numbers::pi;
}

TEST_F(GtaoTruth, HorizonsMeetBruteForceInEverySceneAndView) {
  const float radius = 1.2f;
  for (const TestView& view : test_views()) {
    for (const NamedScene& scene : gtao_scenes()) {
      SCOPED_TRACE(testing::Message() << scene.name << ", " << view.name);
      const Drawing drawing = draw(view, 60, 40, scene.scene);
      const auto images = run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs},
                                        exact(Estimator::horizons, radius));
      const Errors errors = errors_of(images.visibility, drawing, radius);
      EXPECT_LT(errors.mean, 0.008);
      // Silhouettes lie between pixels, and the ball's contact is narrower than one.
      EXPECT_LT(errors.largest, scene.name == "ball" ? 0.3 : 0.08);
    }
  }
}

TEST_F(GtaoTruth, TheBitmaskMeetsBruteForceWhereAllThatIsHiddenOccludes) {
  const float radius = 1.2f;
  const TestView view = test_views()[2];
  for (const NamedScene& scene : gtao_scenes()) {
    SCOPED_TRACE(scene.name);
    const Drawing drawing = draw(view, 60, 40, scene.scene);
    const auto images = run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs},
                                      exact(Estimator::bitmask, radius));
    const Errors errors = errors_of(images.visibility, drawing, radius);
    EXPECT_LT(errors.mean, 0.02);
    EXPECT_LT(errors.largest, scene.name == "ball" ? 0.3 : 0.08);
  }
}

// Visibility of a floor at distance d from a long platform of height h: (1 + cos atan(h / d)) / 2.
TEST_F(GtaoTruth, AFloorBeforeAPlatformHasTheClosedForm) {
  const TestView view = orthographic_view("orthographic", 4.0, 4.0, 0.1, 20.0);
  const double height = 0.5;
  const Drawing drawing = draw(view, 128, 128, step(0.0, height));
  for (const Estimator estimator : {Estimator::horizons, Estimator::bitmask}) {
    SCOPED_TRACE(name_of(estimator));
    const auto images =
        run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs}, exact(estimator, 8.0f));
    for (std::uint32_t x = 44; x < 62; ++x) {
      const double distance = (64 - x - 0.5) * 8.0 / 128;
      const double expected = 0.5 + 0.5 * distance / std::hypot(distance, height);
      EXPECT_NEAR(images.visibility.at(x, 64), expected, 0.025) << distance << " units away";
    }
    for (std::uint32_t x = 66; x < 120; ++x) {
      EXPECT_NEAR(images.visibility.at(x, 64), 1.0, 0.004);
    }
  }
}

// On a wall of a groove whose walls are an angle a apart: (1 - cos a) / 2 near the bottom.
TEST_F(GtaoTruth, AGrooveHasTheClosedFormNearItsBottom) {
  const TestView view = orthographic_view("orthographic", 4.0, 4.0, 0.1, 20.0);
  for (const double half_angle : {0.5, std::numbers::pi / 4.0, 1.2}) {
    const Drawing drawing = draw(view, 128, 128, groove(half_angle, 9.0));
    const double expected = (1.0 - std::cos(2.0 * half_angle)) / 2.0;
    for (const Estimator estimator : {Estimator::horizons, Estimator::bitmask}) {
      SCOPED_TRACE(testing::Message() << name_of(estimator) << ", half angle " << half_angle);
      const auto images =
          run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs}, exact(estimator, 8.0f));
      for (const std::uint32_t x : {61u, 62u, 65u, 66u}) {
        EXPECT_NEAR(images.visibility.at(x, 64), expected, 0.03);
      }
    }
  }
}

TEST_F(GtaoTruth, WhatLiesBeyondTheRadiusDoesNotOcclude) {
  const TestView view = orthographic_view("orthographic", 4.0, 4.0, 0.1, 20.0);
  const double height = 0.5;
  const Drawing drawing = draw(view, 128, 128, step(0.0, height));
  const float radius = 1.0f;
  for (const Estimator estimator : {Estimator::horizons, Estimator::bitmask}) {
    SCOPED_TRACE(name_of(estimator));
    const auto images =
        run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs}, exact(estimator, radius));
    for (std::uint32_t x = 0; x < 64; ++x) {
      // To the nearest sample on the platform's edge, known to half a pixel. The bitmask joins
      // floor and platform by a slope, whose foot is nearer by the height of the wall and a step.
      const double across = (63.5 - x) * 8.0 / 128;
      const double distance = std::hypot(across, height);
      if ((estimator == Estimator::bitmask ? across / 1.15 : distance) > radius) {
        EXPECT_GT(images.visibility.at(x, 64), 0.996) << "column " << x;
      } else if (distance < 0.8 * radius) {
        EXPECT_LT(images.visibility.at(x, 64), 0.96) << "column " << x;
      }
    }
  }
}

TEST_F(GtaoTruth, BentNormalsMeetBruteForce) {
  const float radius = 1.2f;
  for (const TestView& view : {test_views()[2], test_views()[5]}) {
    for (const NamedScene& scene : gtao_scenes()) {
      for (const Estimator estimator : {Estimator::horizons, Estimator::bitmask}) {
        SCOPED_TRACE(testing::Message()
                     << scene.name << ", " << view.name << ", " << name_of(estimator));
        const Drawing drawing = draw(view, 60, 40, scene.scene);
        OcclusionSettings settings = exact(estimator, radius);
        settings.bent_normal = true;
        const auto images =
            run_occlusion({view.view, drawing.depth_ndc, &drawing.normal_vs}, settings);
        EXPECT_LT(mean_bent_error(images.bent_normal, drawing, radius),
                  estimator == Estimator::horizons ? 2.0 : 6.0);
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
