#include "maths/multi_bounce.h"
#include "random_input.h"
#include "single_passes.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

class MultiBouncePass : public PassTest {
 protected:
  // Adds the pass with a visibility that was written before, and returns its image.
  framegraph::Texture add(Graph& graph, framegraph::Texture visibility, const HostImage& albedo) {
    const OcclusionSettings settings;
    ViewTextures textures{visibility};  // as depth, which the pass does not read
    textures[ALCOVE_IMAGE_ALBEDO] = upload(graph, albedo);
    textures[ALCOVE_IMAGE_VISIBILITY] = visibility;
    textures[ALCOVE_IMAGE_MULTI_BOUNCE] = graph.create_texture(
        "multi-bounce", {VK_FORMAT_R32G32B32A32_SFLOAT, sample::extent_of(graph, visibility)});
    add_passes(graph, gpu().pipelines(),
               {.settings = &settings, .camera = test_views().front().view}, 0, textures,
               [](GraphAdapter&, const ViewInputs& view) {
                 describe_multi_bounce(view, view.image(ALCOVE_IMAGE_VISIBILITY));
               });
    return textures[ALCOVE_IMAGE_MULTI_BOUNCE];
  }
};

struct Inputs {
  HostImage visibility{37, 21, {}, 1};
  HostImage albedo{37, 21, {}, 4};
};

Inputs random_inputs() {
  maths_test::RandomInput random;
  Inputs inputs;
  for (std::uint32_t i = 0; i < 37 * 21; ++i) {
    inputs.visibility.texels.push_back(i == 0 ? 0.0f : i == 1 ? 1.0f : random.uniform(0.0f, 1.0f));
    for (int c = 0; c < 4; ++c) inputs.albedo.texels.push_back(random.uniform(0.0f, 1.0f));
  }
  return inputs;
}

TEST_F(MultiBouncePass, MultiBounceImageAgreesWithTheFormulaInEachColourChannel) {
  const Inputs inputs = random_inputs();
  run([&](Graph& graph) {
    read_back(graph, add(graph, upload(graph, inputs.visibility), inputs.albedo));
  });
  for (std::uint32_t y = 0; y < 21; ++y) {
    for (std::uint32_t x = 0; x < 37; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(
            result().at(x, y, c),
            maths::multi_bounce_channel(inputs.visibility.at(x, y), inputs.albedo.at(x, y, c)),
            1e-5f);
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
