// Tests that every kind of invalid input gives an error sentence that names the fault, and that the
// device still works afterwards.
#include <gmock/gmock.h>

#include <utility>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using testing::HasSubstr;

struct SettingsCase {
  const char* message;
  void (*change)(OcclusionSettings&);
};

class BadInput : public PassTest {
 protected:
  // Tests that add_occlusion() refuses a view and settings.
  void expect_refusal(const View& view, const OcclusionSettings& settings, const char* message) {
    run([&](Graph& graph) {
      const framegraph::Texture depth = upload(graph, drawing_.depth_ndc);
      expect_error(add_occlusion({graph, gpu().kernels(), view, 0}, {depth}, settings), message);
      read_back(graph, depth);
    });
  }
  void expect_refusal(const SettingsCase& bad) {
    OcclusionSettings settings;
    settings.history_frames = 4;
    bad.change(settings);
    expect_refusal(drawing_.view, settings, bad.message);
  }
  framegraph::DeviceHandles handles() {
    framegraph::DeviceHandles handles;
    handles.instance = gpu().device().instance();
    handles.physical_device = gpu().device().physical_device();
    handles.device = gpu().device().device();
    handles.get_instance_proc_addr = vkGetInstanceProcAddr;
    return handles;
  }

  void expect_a_good_frame() {
    const Drawing plane = draw(test_views()[2], 16, 12, {tilted_plane(10.0, 4.0)});
    EXPECT_THAT(render(plane, {}).visibility.texels, testing::Each(testing::Ge(0.95f)));
  }

  const Drawing drawing_ = draw(test_views()[2], 16, 12, groove(0.8));
};

// settings_test.cpp tests the range of each setting, and the tests of maths and of rigid transforms
// which matrices can be used. Here each kind of refusal reaches the caller.
TEST_F(BadInput, SettingsAndInputsThatTheyNeedAreReportedByName) {
  constexpr SettingsCase kCases[] = {
      {"'radius' is 0; it must be above 0 and finite.", [](auto& s) { s.radius = 0.0f; }},
      {"needs a texture of second depth", [](auto& s) { s.depth_layers = 2; }},
      {"needs a texture of back-face depth",
       [](auto& s) { s.thickness_unit = ThicknessUnit::back_faces; }},
  };
  for (const SettingsCase& bad : kCases) expect_refusal(bad);
  expect_a_good_frame();
}

TEST_F(BadInput, MatricesThatCannotBeUsedAreReported) {
  struct Case {
    const char* message;
    void (*change)(View&);
  };
  constexpr Case kCases[] = {
      {"projection matrix", [](View& v) { v.clip_from_view[1] = 0.5f; }},  // mixes x and y
      {"transposed", [](View& v) { std::swap(v.clip_from_view[11], v.clip_from_view[14]); }},
      {"view_from_world", [](View& v) { v.view_from_world[5] = 2.0f; }},
      {"view_from_world", [](View& v) { v.view_from_world[13] = kNaN; }},
  };
  for (const Case& bad : kCases) {
    View view = drawing_.view;
    bad.change(view);
    expect_refusal(view, {}, bad.message);
  }
  expect_a_good_frame();
}

TEST_F(BadInput, RawOcclusionWithWrongTileSizeSlicesOrImageSizeIsReported) {
  struct Case {
    const char* message;
    void (*change)(RawOcclusionTextures&, OcclusionSettings&);
  };
  constexpr Case kCases[] = {
      {"'tile_size' is 0;", [](auto& raw, auto&) { raw.tile_size = 0; }},
      {"'tile_size' is 3;", [](auto& raw, auto&) { raw.tile_size = 3; }},
      {"'tile_size' is 4294967295;", [](auto& raw, auto&) { raw.tile_size = ~0u; }},
      {"'slices' is 0;", [](auto& raw, auto&) { raw.slices = 0; }},
      {"'slices' is 65;", [](auto& raw, auto&) { raw.slices = 65; }},
      {"raw occlusion of 8x6", [](auto& raw, auto&) { raw.tile_size = 1; }},
      {"raw occlusion of 0x0", [](auto& raw, auto&) { raw.raw_occlusion = {}; }},
      {"raw occlusion of 8x6", [](auto& raw, auto&) { raw.lobe = true; }},
      {"bent-normal residuals of 16x12", [](auto& raw, auto&) { raw.bent.index = 0; }},
      {"'roughness' is", [](auto&, auto& settings) { settings.roughness = kNaN; }},
      {"'roughness_channel' is 4; it must be 0 to 3.",
       [](auto&, auto& settings) { settings.roughness_channel = 4; }},
  };
  for (const Case& bad : kCases) {
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), drawing_.view, 0};
      const framegraph::Texture depth = upload(graph, drawing_.depth_ndc);  // has index 0
      const framegraph::Texture normals = upload(graph, drawing_.normal_vs);
      OcclusionSettings search;
      search.tile_size = 2;
      search.bent_normal = true;
      auto raw = add_gtao(
          frame,
          {{.depth_ndc = depth, .normals = normals, .normal_convention = {.in_view_space = true}}},
          search);
      ASSERT_TRUE(raw);
      OcclusionSettings settings;
      bad.change(*raw, settings);
      expect_error(
          add_reconstruct(frame, {{.depth_ndc = depth, .normals = normals}, *raw}, settings),
          bad.message);
      read_back(graph, depth);
    });
  }
  expect_a_good_frame();
}

TEST_F(BadInput, FrameInFlightSlotOutOfRangeIsReported) {
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    gpu().kernels().begin_frame(8);
    const Frame frame{graph, gpu().kernels(), drawing_.view, 0};
    const auto outputs = add_occlusion(frame, {upload(graph, drawing_.depth_ndc)}, {});
    EXPECT_TRUE(outputs);
    graph.output(outputs->visibility);
    return {};
  });
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error(), HasSubstr("frames in flight"));
  expect_a_good_frame();
}

TEST_F(BadInput, NumberOfFramesInFlightOutOfRangeIsReported) {
  for (const std::uint32_t frames : {0u, 9u, ~0u}) {
    expect_error(Kernels::create(handles(), frames), std::to_string(frames) + " frames in flight");
  }
}

TEST_F(BadInput, InputImageWithoutPixelsIsReported) {
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    const auto depth = graph.create_texture("empty depth", {VK_FORMAT_R32_SFLOAT, {}});
    expect_error(add_occlusion({graph, gpu().kernels(), drawing_.view, 0}, {depth}, {}),
                 "no pixels");
    return {};
  });
  // The graph in which the invalid texture was declared is refused too.
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error(), HasSubstr("'empty depth'"));
  expect_a_good_frame();
}

TEST_F(BadInput, InputImagesOfDifferentSizesAreReported) {
  const Drawing low = draw(test_views()[2], 16, 11, groove(0.8));
  run([&](Graph& graph) {
    const framegraph::Texture depth = upload(graph, drawing_.depth_ndc);
    const framegraph::Texture image = upload(graph, low.depth_ndc);
    OcclusionSettings settings;
    settings.thickness_unit = ThicknessUnit::back_faces;
    settings.depth_layers = 2;
    const auto expect = [&](framegraph::Texture OcclusionInputs::*input, const char* name) {
      OcclusionInputs inputs{
          .depth_ndc = depth, .back_depth_ndc = depth, .second_depth_ndc = depth};
      inputs.*input = image;
      expect_error(add_occlusion({graph, gpu().kernels(), drawing_.view, 0}, inputs, settings),
                   name + std::string(" of 16x11"));
    };
    expect(&OcclusionInputs::normals, "normals");
    expect(&OcclusionInputs::motion, "motion vectors");
    expect(&OcclusionInputs::back_depth_ndc, "back-face depth");
    expect(&OcclusionInputs::second_depth_ndc, "second depth");
    read_back(graph, depth);
  });
  expect_a_good_frame();
}

TEST_F(BadInput, MissingDepthImageIsReported) {
  run([&](Graph& graph) {
    expect_error(add_occlusion({graph, gpu().kernels(), drawing_.view, 0}, {}, {}), "depth");
  });
  expect_a_good_frame();
}

}  // namespace
}  // namespace alcove::passes
