#include "evaluate/output_needs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alcove::sample {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::uint32_t kSide = 10;

// A view of rows of surfaces with two materials: the first one is plain; the first `special` rows
// have the second.
struct View {
  explicit View(const Material& second, std::uint32_t special = 3) {
    scene.materials = {Material{}, second};
    seen.albedo = Image<glm::vec3>(kSide, kSide, glm::vec3(second.base_color));
    seen.roughness = Image<float>(kSide, kSide, 1.0f);
    seen.material = Image<std::uint32_t>(kSide, kSide);
    seen.shading_normal_ws = Image<glm::vec3>(kSide, kSide, glm::vec3(0, 0, 1));
    for (std::uint32_t i = 0; i < special * kSide; ++i) {
      seen.roughness.pixels[i] = second.roughness;
      seen.material.pixels[i] = 1;
    }
    truths.surfaces = Mask(kSide, kSide, 1);
    truths.scene.visibility = Image<float>(kSide, kSide, 0.6f);
    truths.scene.bent_normal_ws = seen.shading_normal_ws;
  }
  // The sentences, with outputs that take a quarter more time.
  std::vector<std::string> needs() const {
    const auto found = output_needs(scene, seen, truths, [](const auto& change) -> Result<double> {
      OcclusionSettings settings;
      const OcclusionSettings before;
      change(settings);
      return settings == before ? 0.0 : 0.25;
    });
    EXPECT_TRUE(found) << found.error();
    EXPECT_EQ(found->size(), 6u);
    return *found;
  }

  Scene scene;
  GBuffer seen;
  Truths truths;
};

Material dark() { return {.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)}; }

TEST(OutputNeeds, PlainDarkAndRoughSurfacesNeedNoOutputBesideVisibility) {
  for (const std::string& sentence : View(dark()).needs())
    EXPECT_THAT(sentence, HasSubstr(": not needed here, "));
}

TEST(OutputNeeds, GlossySurfacesNeedSpecularOcclusion) {
  Material glossy = dark();
  glossy.roughness = 0.2f;
  EXPECT_THAT(View(glossy).needs()[0],
              AllOf(StartsWith("specular occlusion (specular=slices): 30 % of the surfaces"),
                    HasSubstr("0.40 less than 1"), HasSubstr("25 % more time")));
  EXPECT_THAT(View(glossy, 0).needs()[0], HasSubstr("not needed here"));
}

TEST(OutputNeeds, TiltedUnoccludedDirectionsNeedBentNormals) {
  View view(dark());
  for (glm::vec3& direction : view.truths.scene.bent_normal_ws.pixels)
    direction = glm::normalize(glm::vec3(1, 0, 1));
  EXPECT_THAT(view.needs()[1], AllOf(HasSubstr("45 degrees"), Not(HasSubstr("not needed"))));
}

TEST(OutputNeeds, BrightSurfacesNeedMultiBounce) {
  Material bright;
  bright.base_color = {0.9f, 0.3f, 0.2f, 1.0f};
  EXPECT_THAT(View(bright).needs()[2],
              AllOf(StartsWith("multi-bounce"), Not(HasSubstr("not needed"))));
}

TEST(OutputNeeds, NormalMapsAlphaMasksAndAnimationsAskForInputsAndSettings) {
  Material leaf = dark();
  leaf.normal_texture.image = 0;
  leaf.alpha_mode = AlphaMode::mask;
  View view(leaf);
  view.scene.has_animations = true;
  for (const std::size_t i : {3, 4, 5}) EXPECT_THAT(view.needs()[i], Not(HasSubstr("not needed")));
}

TEST(OutputNeeds, SceneOfOnePlainMaterialHasNoSentences) {
  View view(dark());
  view.scene.materials.resize(1);
  const auto found = output_needs(view.scene, view.seen, view.truths,
                                  [](const auto&) -> Result<double> { return 0.0; });
  ASSERT_TRUE(found) << found.error();
  EXPECT_TRUE(found->empty());
}

}  // namespace
}  // namespace alcove::sample
