// Tests that every kind of invalid input gives an error sentence that names the fault, and that the
// device still works afterwards.
#include <gmock/gmock.h>

#include <utility>

#include "comma_locale.h"
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

TEST_F(BadInput, SettingsOutOfRangeAreReportedByName) {
  constexpr SettingsCase kCases[] = {
      {"'radius' is 0; it must be above 0 and finite.", [](auto& s) { s.radius = 0.0f; }},
      {"'radius' is", [](auto& s) { s.radius = -1.0f; }},
      {"'radius' is", [](auto& s) { s.radius = kNaN; }},
      {"'radius' is", [](auto& s) { s.radius = kInfinity; }},
      {"'steps' is", [](auto& s) { s.steps = 0; }},
      {"'steps' is", [](auto& s) { s.steps = 65; }},
      {"'slices' is", [](auto& s) { s.slices = 0; }},
      {"'slices' is", [](auto& s) { s.slices = 4000000000u; }},
      {"'tile_size' is", [](auto& s) { s.tile_size = 3; }},
      {"'tile_size' is", [](auto& s) { s.tile_size = 0; }},
      {"'thickness' is", [](auto& s) { s.thickness = -0.1f; }},
      {"'thickness' is", [](auto& s) { s.thickness = kNaN; }},
      {"'thickness' is", [](auto& s) { s.thickness = kInfinity; }},
      {"'hidden_occlusion' is", [](auto& s) { s.hidden_occlusion = 1.5f; }},
      {"'falloff' is", [](auto& s) { s.advanced.falloff = -0.5f; }},
      {"with the estimator connected", [](auto& s) { s.advanced.falloff = 0.5f; }},
      {"'hidden_occlusion' is", [](auto& s) { s.hidden_occlusion = kNaN; }},
      {"'filter_tolerance_px' is", [](auto& s) { s.advanced.filter_tolerance_px = 0.0f; }},
      {"'filter_tolerance_px' is", [](auto& s) { s.advanced.filter_tolerance_px = kNaN; }},
      {"'filter_tolerance_px' is", [](auto& s) { s.advanced.filter_tolerance_px = kInfinity; }},
      {"'filter_radius' is 4; it must be 0 to 3.", [](auto& s) { s.advanced.filter_radius = 4; }},
      {"'history_frames' is 128; it must be 0 to 127.", [](auto& s) { s.history_frames = 128; }},
      {"'roughness' is", [](auto& s) { s.roughness = 1.1f; }},
      {"'roughness' is", [](auto& s) { s.roughness = kNaN; }},
      {"'roughness_channel' is 4; it must be 0 to 3.", [](auto& s) { s.roughness_channel = 4; }},
      {"'power' is", [](auto& s) { s.power = 0.0f; }},
      {"'power' is", [](auto& s) { s.power = kNaN; }},
      {"'intensity' is", [](auto& s) { s.intensity = -1.0f; }},
      {"'intensity' is", [](auto& s) { s.intensity = 17.0f; }},
      {"'depth_layers' is", [](auto& s) { s.depth_layers = 0; }},
      {"'depth_layers' is", [](auto& s) { s.depth_layers = 3; }},
      {"needs a texture of second depth", [](auto& s) { s.depth_layers = 2; }},
      {"needs a texture of back-face depth",
       [](auto& s) { s.advanced.thickness_unit = ThicknessUnit::back_faces; }},
  };
  for (const SettingsCase& bad : kCases) expect_refusal(bad);
  expect_a_good_frame();
}

TEST_F(BadInput, NumbersInErrorMessagesAreShortAndExactInEveryLocale) {
  const CommaLocale comma;
  constexpr SettingsCase kCases[] = {
      {"'radius' is -1e-07;", [](auto& s) { s.radius = -1e-7f; }},
      {"'thickness' is -1.5;", [](auto& s) { s.thickness = -1.5f; }},
      {"'hidden_occlusion' is 1.0000001;", [](auto& s) { s.hidden_occlusion = 1.0000001f; }},
      {"'falloff' is 1e-09 with", [](auto& s) { s.advanced.falloff = 1e-9f; }},
      {"'filter_tolerance_px' is -0.25;", [](auto& s) { s.advanced.filter_tolerance_px = -0.25f; }},
      {"'roughness' is 1.1;", [](auto& s) { s.roughness = 1.1f; }},
      {"'history_frames' is 256;", [](auto& s) { s.history_frames = 256; }},
      {"'slices' is 1234567;", [](auto& s) { s.slices = 1234567; }},
  };
  for (const SettingsCase& bad : kCases) expect_refusal(bad);
}

TEST_F(BadInput, InvalidProjectionMatrixIsReported) {
  constexpr void (*kChanges[])(Matrix&) = {
      [](Matrix& m) { m.fill(0.0f); },         [](Matrix& m) { m[0] = kNaN; },
      [](Matrix& m) { m[10] = kInfinity; },    [](Matrix& m) { m[5] = 0.0f; },
      [](Matrix& m) { m[11] = 1.0f; },  // the camera looks along +Z
      [](Matrix& m) { m[10] = m[14] = 0.0f; },  // all points have the same depth
      [](Matrix& m) { m[2] = 0.4f; },  // oblique near plane
      [](Matrix& m) { m[1] = 0.5f; },  // mixes x and y
  };
  for (const auto change : kChanges) {
    View view = drawing_.view;
    change(view.clip_from_view);
    expect_refusal(view, {}, "projection matrix");
  }
  expect_a_good_frame();
}

TEST_F(BadInput, ViewMatrixThatScalesOrIsNotFiniteIsReported) {
  for (const auto& [element, value] :
       {std::pair{5u, 0.0f}, {5u, 2.0f}, {5u, kNaN}, {5u, kInfinity}, {13u, kNaN}}) {
    View view = drawing_.view;
    view.view_from_world[element] = value;
    expect_refusal(view, {}, "view_from_world");
  }
  expect_a_good_frame();
}

TEST_F(BadInput, TransposedProjectionMatrixIsReported) {
  for (const TestView& test : test_views()) {
    if (test.orthographic) continue;
    SCOPED_TRACE(test.name);
    View view;
    for (std::size_t i = 0; i < 16; ++i)
      view.clip_from_view[i] = test.view.clip_from_view[4 * (i % 4) + i / 4];
    expect_refusal(view, {}, "transposed");
  }
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
      auto raw = add_gtao(frame, {depth, normals, {.in_view_space = true}}, search);
      ASSERT_TRUE(raw);
      OcclusionSettings settings;
      bad.change(*raw, settings);
      expect_error(
          add_reconstruct(frame, {.raw_occlusion = *raw, .depth_ndc = depth, .normals = normals},
                          settings),
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
    settings.advanced.thickness_unit = ThicknessUnit::back_faces;
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
