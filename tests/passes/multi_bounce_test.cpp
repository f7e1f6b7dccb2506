#include "alcove/passes/multi_bounce.h"

#include "maths/multi_bounce.h"
#include "pass_fixture.h"
#include "random_input.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

using MultiBouncePass = PassTest;

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
    const Frame frame{graph, gpu().kernels(), {}, 0};
    const auto result =
        add_multi_bounce(frame, {upload(graph, inputs.visibility), upload(graph, inputs.albedo)},
                         Precision::float32);
    ASSERT_TRUE(result) << result.error().message;
    read_back(graph, *result);
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

TEST_F(MultiBouncePass, MultiBouncePassIsCulledIfNobodyReadsItsOutput) {
  const Inputs inputs = random_inputs();
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), {}, 0};
    const framegraph::Texture visibility = upload(graph, inputs.visibility);
    ASSERT_TRUE(add_multi_bounce(frame, {visibility, upload(graph, inputs.albedo)}));
    read_back(graph, visibility);
  });
  for (const framegraph::PassTiming& timing : gpu().timings())
    EXPECT_NE(timing.name, "multi-bounce");
}

TEST_F(MultiBouncePass, MissingAlbedoAndInputsOfDifferentSizesAreRefused) {
  const Inputs inputs = random_inputs();
  const HostImage small{2, 2, std::vector<float>(16), 4};
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), {}, 0};
    const framegraph::Texture visibility = upload(graph, inputs.visibility);
    expect_error(add_multi_bounce(frame, {visibility, {}}), "albedo");
    expect_error(add_multi_bounce(frame, {visibility, upload(graph, small)}), "37x21");
    read_back(graph, visibility);
  });
}

}  // namespace
}  // namespace alcove::passes
