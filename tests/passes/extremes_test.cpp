// Tests every preset with the largest, the smallest and invalid numbers.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 57;
constexpr std::uint32_t kHeight = 39;

AlcoveCamera moved_by(AlcoveCamera view, double x) {
  view.view_from_world[12] = static_cast<float>(x);
  return view;
}

class Extremes : public PassTest, public testing::WithParamInterface<AlcoveQuality> {
 protected:
  using Images = HostOutputs;

  // Returns the images of several frames. The camera moves sideways by `step` per frame. The scene
  // is so far away that no surface moves on the image, so that history texels can only be rejected
  // because of their depth.
  std::vector<Images> strafe(const TestView& view, const Scene& scene, double step,
                             const OcclusionSettings& settings, std::uint32_t frames) {
    const Drawing drawing = draw(view, kWidth, kHeight, scene);
    std::vector<Images> images;
    for (std::uint32_t i = 0; i < frames; ++i) {
      HostView frame = make_view(drawing, settings, i);
      frame.view = moved_by(view.view, -step * i);
      frame.previous_view = moved_by(view.view, -step * (i - 1.0));
      images.push_back(run_occlusion(frame, i));
    }
    return images;
  }

  static void expect_sound(const Images& images) {
    const auto in_range = testing::Each(testing::AllOf(testing::Ge(0.0f), testing::Le(1.0f)));
    EXPECT_THAT(images.visibility.texels, in_range);
    EXPECT_THAT(images.specular.texels, in_range);
    for (std::size_t i = 0; i < images.bent_normal.texels.size(); i += 4) {
      const float* bent = &images.bent_normal.texels[i];
      ASSERT_NEAR(std::hypot(bent[0], bent[1], bent[2]), 1.0, 1e-3) << "pixel " << i / 4;
    }
  }
};

TEST_P(Extremes, ImagesWithHistoryAreIndependentOfTheUnitOfLength) {
  for (const bool orthographic : {false, true}) {
    std::vector<Images> expected;
    for (const int exponent : {0, -30, 17, 30}) {
      SCOPED_TRACE(testing::Message() << (orthographic ? "orthographic" : "perspective")
                                      << " in units of 2^" << -exponent);
      const double unit = std::ldexp(1.0, exponent);
      const TestView view =
          orthographic ? orthographic_view("", 3.0 * unit, 2.0 * unit, 0.125 * unit, 16.125 * unit)
                       : perspective_view("", 1.2, 1.8, 0.125 * unit, kInfinity, true);
      const std::vector<Images> series =
          strafe(view, transform(ball_on_floor(), unit), 0.05 * unit,
                 all_outputs(GetParam(), static_cast<float>(unit)), 3);
      if (exponent == 0) expected = series;
      for (std::size_t i = 0; i < series.size(); ++i) expect_equal(series[i], expected[i]);
    }
  }
}

// Tests near planes in front of the eye and behind it. Some engines place the near plane of an
// orthographic view behind the eye.
TEST_P(Extremes, OrthographicNearPlaneMayBeInFrontOfOrBehindTheEye) {
  const OcclusionSettings settings = all_outputs(GetParam(), 1.0f);
  for (const NamedScene& scene : gtao_scenes()) {
    std::vector<Images> expected;
    for (const double shift : {0.0, 4.125, 1024.0, -1024.0}) {
      SCOPED_TRACE(testing::Message() << scene.name << " moved by " << shift);
      const TestView view = orthographic_view("", 3.0, 2.0, 0.125 - shift, 16.125 - shift);
      const std::vector<Images> series =
          strafe(view, transform(scene.scene, 1.0, {0.0, 0.0, shift}), 0.05, settings, 4);
      if (shift == 0.0) expected = series;
      // At a distance of 1024 depths are rounded more; the largest difference is .0020.
      for (std::size_t i = 0; i < series.size(); ++i)
        EXPECT_LT(rms(series[i].visibility, expected[i].visibility), 0.0025) << "frame " << i;
    }
  }
}

// The camera is static at coordinates so large that adjacent floats differ by more than 0.05.
// Motion vectors are given.
TEST_P(Extremes, HistoryIsKeptFarFromTheWorldOrigin) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, ball_on_floor());
  const OcclusionSettings settings = all_outputs(GetParam(), 1.0f);
  const auto visibility_at = [&](double distance) {
    glm::dmat4 rotated = glm::rotate(glm::dmat4(1.0), 0.9, glm::dvec3(0.3, 0.7, -0.2));
    rotated = glm::translate(rotated, distance * glm::dvec3(-1.0, -0.3, 0.8));
    HostView frame = make_view(drawing, settings);
    for (int i = 0; i < 16; ++i)
      frame.view.view_from_world[i] = static_cast<float>(rotated[i / 4][i % 4]);
    frame.previous_view = frame.view;
    frame.motion = uniform(kWidth, kHeight, {0.0f, 0.0f});
    HostImage visibility;
    for (std::uint32_t i = 0; i < 8; ++i, frame.reset = false)
      visibility = run_occlusion(frame, i).visibility;
    return visibility;
  };
  EXPECT_LT(rms(visibility_at(1e6), visibility_at(0.0)), 1e-3);
}

TEST_P(Extremes, InvalidNormalsAndRoughnessInOneFrameDoNotPersistInTheHistory) {
  constexpr std::array kHoles{0u, 20 * kWidth + 28, 20 * kWidth + 29, 7 * kWidth + 40};
  for (const TestView& view : {test_views()[2], test_views().back()}) {
    const Drawing clean = draw(view, kWidth, kHeight, ball_on_floor());
    const OcclusionSettings settings = all_outputs(GetParam(), 1.0f);
    // Renders several frames. Frame 1 has the value `wrong` in its normals or roughness.
    const auto frames = [&](float wrong, bool in_normals) {
      std::vector<Images> images;
      for (std::uint32_t i = 0; i < 5; ++i) {
        HostView frame = make_view(clean, settings, i);
        frame.view = moved_by(view.view, 0.01 * i);
        frame.previous_view = moved_by(view.view, 0.01 * (i - 1.0));
        frame.roughness = uniform(kWidth, kHeight, {0.4f});
        HostImage& invalid = in_normals ? frame.normals : frame.roughness;
        for (const std::uint32_t hole : kHoles) {
          const auto texel = invalid.texels.begin() + std::ptrdiff_t{hole} * invalid.channels;
          std::fill_n(texel, i == 1 ? invalid.channels : 0, wrong);
        }
        images.push_back(run_occlusion(frame, i));
      }
      return images;
    };
    const std::vector<Images> expected = frames(0.4f, false);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float wrong : {kNaN, infinity, 0.0f, -1e30f}) {
      for (const bool in_normals : {true, false}) {
        SCOPED_TRACE(testing::Message() << view.name << ": " << wrong
                                        << (in_normals ? " in normals" : " as roughness"));
        const std::vector<Images> series = frames(wrong, in_normals);
        for (const Images& images : series) expect_sound(images);
        // The wrong values are in one of the five accumulated frames, so that pixels with wrong
        // values may differ a little.
        EXPECT_LT(rms(series[4].visibility, expected[4].visibility), 2e-3);
        EXPECT_LT(rms(series[4].bent_normal, expected[4].bent_normal), 4e-3);
        EXPECT_LT(rms(series[4].specular, expected[4].specular), 4e-3);
      }
    }
  }
}

// Every traced pixel of a tile lies on a surface that is 10^10 times nearer than the other pixels.
// The weights of the traced pixels for the other pixels are tiny, and must not become zero.
TEST_P(Extremes, SurfacesFarBehindAllTracedPixelsKeepTheirVisibility) {
  constexpr std::uint32_t kSide = 64;
  const TestView view = perspective_view("", 1.2, 1.2, 0.01, kInfinity, true);
  std::vector<double> means;
  for (const double distance : {1e4, 1e10}) {
    Drawing far = draw(view, kSide, kSide, groove(0.3, distance));
    const Drawing near = draw(view, kSide, kSide, {plane({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0})});
    for (std::uint32_t i = 0; i < kSide * kSide; i += i % kSide == kSide - 4 ? 3 * kSide + 4 : 4) {
      far.depth_ndc.texels[i] = near.depth_ndc.texels[i];
      std::copy_n(&near.normal_vs.texels[std::size_t{i} * 4], 4,
                  &far.normal_vs.texels[std::size_t{i} * 4]);
    }
    OcclusionSettings settings = all_outputs(GetParam(), static_cast<float>(0.3 * distance));
    settings.history_frames = 0;
    const Images images = render(far, settings);
    expect_sound(images);
    means.push_back(mean(images.visibility));
  }
  EXPECT_LT(means[0], 0.9995);
  EXPECT_NEAR(means[1], means[0], 1e-4);
}

TEST_P(Extremes, AnyOcclusionRadiusGivesFiniteValuesInRange) {
  for (const TestView& view : {test_views()[2], test_views().back()}) {
    const Drawing drawing = draw(view, kWidth, kHeight, ball_on_floor());
    std::vector<HostImage> largest;
    for (const float radius : {1e-30f, 1e-5f, 1e-3f, 1.0f, 1e6f, 1e12f, 1e30f, 3e38f}) {
      SCOPED_TRACE(testing::Message() << view.name << ", radius " << radius);
      OcclusionSettings settings = all_outputs(GetParam(), radius);
      settings.history_frames = 0;
      const Images images = render(drawing, settings);
      expect_sound(images);
      if (radius <= 1e-3f) {
        EXPECT_THAT(images.visibility.texels, testing::Each(1.0f));
      }
      if (radius >= 1e6f) largest.push_back(images.visibility);
    }
    for (const HostImage& visibility : largest) {
      EXPECT_THAT(visibility.texels,
                  testing::Pointwise(testing::FloatNear(2e-4f), largest[0].texels));
    }
  }
}

TEST_P(Extremes, ImageSizeMayChangeToOnePixelAndBackBetweenFrames) {
  constexpr VkExtent2D kLargest{64, 48};
  constexpr std::array<VkExtent2D, 9> kSizes{
      {{1, 1}, {64, 48}, {1, 1}, {1, 48}, {64, 1}, {3, 5}, {2, 2}, {63, 47}, {1, 1}}};
  const TestView view = test_views()[2];
  const OcclusionSettings settings = all_outputs(GetParam(), 1.0f);
  // The frame counter wraps around within these frames.
  std::uint32_t index = std::numeric_limits<std::uint32_t>::max() - 4;
  VkExtent2D previous = kSizes[0];
  for (const VkExtent2D size : kSizes) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    const Drawing drawing = draw(view, size.width, size.height, ball_on_floor());
    HostView frame = make_view(drawing, settings);
    frame.reset = false;
    frame.largest_size = kLargest;
    frame.previous_size = previous;
    expect_sound(run_occlusion(frame, index++));
    previous = size;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, Extremes,
                         testing::Values(ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_LOW,
                                         ALCOVE_QUALITY_MEDIUM, ALCOVE_QUALITY_HIGH,
                                         ALCOVE_QUALITY_ULTRA, ALCOVE_QUALITY_HEIGHT_FIELD),
                         [](const auto& each) {
                           return std::string(kQualityNames.at(each.param));
                         });

}  // namespace
}  // namespace alcove::passes
