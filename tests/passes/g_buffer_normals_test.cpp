// Tests normals of a g-buffer that face away from the eye or are missing.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;

// Returns the drawing with all components of the normal of every `stride`th pixel replaced.
Drawing replace_normals(Drawing drawing, float component, std::size_t stride) {
  HostImage& normals = drawing.normal_vs;
  for (std::size_t i = 0; i < normals.texels.size(); i += stride * normals.channels)
    std::fill_n(&normals.texels[i], 3, component);
  return drawing;
}

Drawing invert_normals(Drawing drawing) {
  for (float& component : drawing.normal_vs.texels) component = -component;
  return drawing;
}

class NormalsOfAGBuffer : public PassTest {
 protected:
  HostOutputs third_frame(const Drawing& drawing, const OcclusionSettings& settings) {
    for (std::uint32_t i = 0; i < 2; ++i) (void)render(drawing, settings, i);
    return render(drawing, settings, 2);
  }
};

TEST_F(NormalsOfAGBuffer, NormalsThatFaceAwayFromTheEyeGiveTheSameImagesAsFacingOnes) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, ball_on_floor());
  for (const AlcoveSpecular specular : {ALCOVE_SPECULAR_SLICES, ALCOVE_SPECULAR_TABLE}) {
    const OcclusionSettings settings = all_outputs(ALCOVE_QUALITY_MEDIUM, 0.5f, specular);
    const HostOutputs outputs = third_frame(invert_normals(drawing), settings);
    const HostOutputs expected = third_frame(drawing, settings);
    EXPECT_LT(rms(outputs.visibility, expected.visibility), 2e-3);
    EXPECT_LT(rms(outputs.bent_normal, expected.bent_normal), 0.02);
    EXPECT_LT(rms(outputs.specular, expected.specular), 5e-3);
  }
}

TEST_F(NormalsOfAGBuffer, NaNNormalsNextToTheSkyOrInTinyImagesGiveValidResults) {
  const TestView view = test_views()[2];
  Shape post = plane({0.0, 0.0, -4.0}, {0.3, 0.0, 1.0});
  post.keep = [](const glm::dvec3& p) { return std::abs(p.x) < 0.8; };
  for (const auto& [width, height] : {std::pair{kWidth, kHeight}, {1u, 1u}, {1u, 7u}, {7u, 1u}}) {
    const Drawing drawing = draw(view, width, height, {post});
    const HostOutputs images =
        third_frame(replace_normals(drawing, kNaN, 1), all_outputs(ALCOVE_QUALITY_MEDIUM));
    EXPECT_THAT(images.visibility.texels, testing::Each(testing::Ge(0.97f)));
    for (const HostImage* image : {&images.bent_normal, &images.specular})
      EXPECT_TRUE(std::ranges::all_of(image->texels, [](float t) { return std::isfinite(t); }));
  }
}

}  // namespace
}  // namespace alcove::passes
