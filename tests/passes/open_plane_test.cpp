// Tests that a plane, which nothing occludes, is open in every preset and view, with inputs of any
// quality: its visibility and specular visibility are 1, and its bent normal is its normal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alcove/passes/setting_table.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 64;

struct Case {
  std::string name;
  TestView view;
  Shape plane;
  float radius = 0.5f;
  float normals = 1.0f;  // a factor of all normals
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool every_preset = true;                 // or `medium` alone
  float visibility = 1.0f - 1.0f / 255.0f;  // least values
  float specular = 0.97f;
};

// Returns a view with an angle of `degrees` between the upper and the lower border of the image.
TestView wide_view(double degrees) {
  const double scale = 1.0 / std::tan(degrees * std::numbers::pi / 360.0);
  return perspective_view("", scale / 1.5, scale, 0.01, kInfinity, true);
}

std::vector<Case> open_planes() {
  std::vector<Case> all;
  for (const TestView& view : test_views())
    for (const double tilt : {0.0, 60.0, 85.0})
      all.push_back({.name = view.name + ", tilted " + std::to_string(tilt),
                     .view = view,
                     .plane = tilted_plane(tilt, 4.0),
                     .every_preset = view.name == "reversed infinite" || view.orthographic});
  // A plane with a tilt of 85 degrees is nearer to the eye than the radius.
  for (const auto& [degrees, tilt] :
       {std::pair{1.0, 75.0}, {120.0, 85.0}, {160.0, 75.0}, {160.0, 85.0}, {170.0, 75.0}})
    all.push_back({.name = std::to_string(degrees) + " degrees, tilted " + std::to_string(tilt),
                   .view = wide_view(degrees),
                   .plane = tilted_plane(tilt, 4.0)});
  // The eye is 0.07 radii above the plane, and looks along it.
  for (const double degrees : {1.0, 60.0, 120.0})
    all.push_back({.name = std::to_string(degrees) + " degrees, seen edge-on",
                   .view = wide_view(degrees),
                   .plane = plane({0.0, -0.035, 0.0}, {0.0, std::cos(0.0087), std::sin(0.0087)})});
  all.push_back({.name = "half a degree from edge-on",
                 .view = wide_view(1.0),
                 .plane = tilted_plane(89.5, 4.0),
                 .specular = 0.85f});
  const TestView view = wide_view(60.0);
  for (const float radius : {1e-3f, 1e4f, 1e30f})
    all.push_back(
        {.name = "radius", .view = view, .plane = tilted_plane(70.0, 4.0), .radius = radius});
  for (const float factor : {-1.0f, 0.0f, kNaN})
    all.push_back({.name = "normals times " + std::to_string(factor),
                   .view = view,
                   .plane = tilted_plane(60.0, 4.0),
                   .normals = factor});
  all.push_back({.name = "orthographic, behind the eye",
                 .view = orthographic_view("", 3.0, 2.0, -16.0, 16.0),
                 .plane = tilted_plane(30.0, -4.0)});
  // The depth buffer is too coarse for the distance of the plane.
  const double slope = std::atan2(60.0, 500.0);
  TestView deep = orthographic_view("", 6.0, 4.0, -1e7, 100.0);
  deep.view.clip_from_view[10] = -deep.view.clip_from_view[10];
  deep.view.clip_from_view[14] = static_cast<float>(100.0 / (100.0 + 1e7));
  for (const float radius : {0.5f, 20.0f}) {
    all.push_back({.name = "floats that are not reversed",
                   .view = perspective_view("", 25.5, 38.2, 0.01, 5000.0, false),
                   .plane = plane({0.0, 0.0, -503.6}, {0.0, std::cos(slope), std::sin(slope)}),
                   .radius = radius,
                   .depth_format = VK_FORMAT_D32_SFLOAT,
                   .every_preset = false});
    all.push_back({.name = "16 bits",
                   .view = perspective_view("", 1.2, 1.8, 0.1, 1000.0, false),
                   .plane = plane({0.0, 0.0, -50.0}, {0.0, 0.8, 0.6}),
                   .radius = radius,
                   .depth_format = VK_FORMAT_D16_UNORM,
                   .every_preset = false});
    all.push_back({.name = "a deep orthographic view",
                   .view = deep,
                   .plane = plane({0.0, 0.0, -20.0}, {0.0, 0.7, 0.7}),
                   .radius = radius,
                   .depth_format = VK_FORMAT_D32_SFLOAT,
                   .every_preset = false});
  }
  return all;
}

class OpenPlane : public PassTest {
 protected:
  HostOutputs frame(const Drawing& drawing, const OcclusionSettings& settings,
                    VkFormat depth_format, std::uint32_t index) {
    HostView view = make_view(drawing, settings, index);
    view.depth_format = depth_format;
    return run_occlusion(view, index);
  }
};

TEST_F(OpenPlane, IsOpenInEveryPreset) {
  for (const Case& each : open_planes()) {
    Drawing drawing = draw(each.view, kWidth, kHeight, {each.plane});
    const HostImage normals = drawing.normal_vs;
    for (float& component : drawing.normal_vs.texels) component *= each.normals;
    if (each.depth_format == VK_FORMAT_D16_UNORM)
      drawing.depth_ndc = with_16_bits(drawing.depth_ndc);
    for (std::size_t i = 0; i < kQualityNames.size(); ++i) {
      const auto quality = static_cast<AlcoveQuality>(i);
      if (!each.every_preset && quality != ALCOVE_QUALITY_MEDIUM) continue;
      const OcclusionSettings settings = all_outputs(
          quality, each.radius,
          quality == ALCOVE_QUALITY_HIGH ? ALCOVE_SPECULAR_TABLE : ALCOVE_SPECULAR_SLICES);
      for (std::uint32_t index = 0; index < 3; ++index) {
        SCOPED_TRACE(testing::Message() << each.name << ", radius " << each.radius << ", "
                                        << kQualityNames.at(quality) << ", frame " << index);
        const HostOutputs images = frame(drawing, settings, each.depth_format, index);
        EXPECT_GE(std::ranges::min(images.visibility.texels), each.visibility);
        EXPECT_GE(std::ranges::min(images.specular.texels), each.specular);
        for (std::size_t p = 0; p < normals.texels.size(); p += 4) {
          double cosine = 0.0;
          for (std::size_t c = p; c < p + 3; ++c)
            cosine += double{images.bent_normal.texels[c]} * normals.texels[c];
          if (drawing.is_sky(p / 4 % kWidth, p / 4 / kWidth)) continue;
          ASSERT_GE(cosine, 0.999) << "pixel " << p / 4;
        }
      }
    }
  }
}

// The tolerance for coarse depth must not remove occlusion that the depth buffer resolves.
TEST_F(OpenPlane, GrooveKeepsItsOcclusionWith16BitDepth) {
  Drawing drawing =
      draw(perspective_view("", 1.2, 1.8, 0.1, 100.0, false), kWidth, kHeight, groove(0.8));
  const OcclusionSettings settings = all_outputs(ALCOVE_QUALITY_MEDIUM, 0.5f);
  const HostImage expected = frame(drawing, settings, VK_FORMAT_D32_SFLOAT, 0).visibility;
  drawing.depth_ndc = with_16_bits(drawing.depth_ndc);
  const HostImage image = frame(drawing, settings, VK_FORMAT_D16_UNORM, 0).visibility;
  EXPECT_LT(rms(image, expected), 0.02);
  EXPECT_LT(std::ranges::min(image.texels), 0.75f);
}

}  // namespace
}  // namespace alcove::passes
