// Tests mistakes of callers that use the graph. c_refusals_test.cpp tests those of a view.
#include <gmock/gmock.h>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using testing::HasSubstr;

class BadInput : public PassTest {
 protected:
  void expect_a_good_frame() {
    const Drawing plane = draw(test_views()[2], 16, 12, {tilted_plane(10.0, 4.0)});
    EXPECT_THAT(render(plane, OcclusionSettings()).visibility.texels,
                testing::Each(testing::Ge(0.95f)));
  }

  const Drawing drawing_ = draw(test_views()[2], 16, 12, groove(0.8));
};

TEST_F(BadInput, FrameInFlightSlotOutOfRangeIsReported) {
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    gpu().pipelines().begin_frame(8);
    ViewTextures textures{upload(graph, drawing_.depth_ndc)};
    add_view_of(graph, {.camera = drawing_.view}, 0, OcclusionSettings(), textures);
    graph.output(textures[ALCOVE_IMAGE_VISIBILITY]);
    return {};
  });
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error(), HasSubstr("frames in flight"));
  expect_a_good_frame();
}

TEST_F(BadInput, NumberOfFramesInFlightOutOfRangeIsReported) {
  for (const std::uint32_t frames : {0u, 9u, ~0u}) {
    expect_error(Pipelines::create(gpu().handles(), frames),
                 std::to_string(frames) + " frames in flight");
  }
}

TEST_F(BadInput, InputImageWithoutPixelsIsReported) {
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    ViewTextures textures{graph.create_texture("empty depth", {VK_FORMAT_R32_SFLOAT, {}})};
    expect_error(sample::add_occlusion(graph, gpu().pipelines(), {.camera = drawing_.view}, 0,
                                       OcclusionSettings(), textures),
                 "depth is 0x0 pixels");
    return {};
  });
  // The graph in which the invalid texture was declared is refused too.
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error(), HasSubstr("'empty depth'"));
  expect_a_good_frame();
}

}  // namespace
}  // namespace alcove::passes
