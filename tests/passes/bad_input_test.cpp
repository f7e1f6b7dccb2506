// Tests that every kind of invalid input gives an error sentence that names the fault, and that the
// device still works afterwards.
#include <gmock/gmock.h>

#include <functional>

#include "comma_locale.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using testing::HasSubstr;

class BadInput : public PassTest {
 protected:
  // Returns the error of add_occlusion() for a view and settings that `spoil` has changed, or an
  // empty text if they are accepted.
  using Spoil = std::function<void(View&, OcclusionSettings&)>;
  std::string error_of(const Spoil& spoil) {
    const Drawing drawing = draw(test_views()[2], 16, 12, groove(0.8));
    std::string said;
    run([&](Graph& graph) {
      View view = test_views()[2].view;
      OcclusionSettings settings;
      settings.history_frames = 4;
      spoil(view, settings);
      const Frame frame{graph, gpu().kernels(), view, 0};
      const framegraph::Texture depth = upload(graph, drawing.depth_ndc);
      const auto outputs = add_occlusion(frame, {depth}, settings);
      if (!outputs) said = outputs.error().message;
      read_back(graph, outputs ? outputs->visibility : depth);
    });
    return said;
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
    const Drawing drawing = draw(test_views()[2], 16, 12, {tilted_plane(10.0, 4.0)});
    const OcclusionImages images =
        run_occlusion({test_views()[2].view, drawing.depth_ndc, &drawing.normal_vs}, {});
    EXPECT_THAT(images.visibility.texels, testing::Each(testing::Ge(0.95f)));
  }
};

bool is_a_sentence(const std::string& text) {
  return !text.empty() && text.back() == '.' && std::isupper(static_cast<unsigned char>(text[0]));
}

TEST_F(BadInput, SettingsOutOfRangeAreReportedByName) {
  struct Case {
    const char* names;
    Spoil spoil;
  };
  const std::vector<Case> cases{
      {"'radius' is 0; it must be above 0 and finite.",
       [](View&, OcclusionSettings& s) { s.radius = 0.0f; }},
      {"'radius' is", [](View&, OcclusionSettings& s) { s.radius = -1.0f; }},
      {"'radius' is", [](View&, OcclusionSettings& s) { s.radius = kNaN; }},
      {"'radius' is", [](View&, OcclusionSettings& s) { s.radius = kInfinity; }},
      {"'steps' is", [](View&, OcclusionSettings& s) { s.steps = 0; }},
      {"'steps' is", [](View&, OcclusionSettings& s) { s.steps = 65; }},
      {"'slices' is", [](View&, OcclusionSettings& s) { s.slices = 0; }},
      {"'slices' is", [](View&, OcclusionSettings& s) { s.slices = 4000000000u; }},
      {"'tile_size' is", [](View&, OcclusionSettings& s) { s.tile_size = 3; }},
      {"'tile_size' is", [](View&, OcclusionSettings& s) { s.tile_size = 0; }},
      {"'thickness' is", [](View&, OcclusionSettings& s) { s.thickness = -0.1f; }},
      {"'thickness' is", [](View&, OcclusionSettings& s) { s.thickness = kNaN; }},
      {"'thickness' is", [](View&, OcclusionSettings& s) { s.thickness = kInfinity; }},
      {"'hidden_occlusion' is", [](View&, OcclusionSettings& s) { s.hidden_occlusion = 1.5f; }},
      {"'falloff' is", [](View&, OcclusionSettings& s) { s.advanced.falloff = -0.5f; }},
      {"with the estimator connected",
       [](View&, OcclusionSettings& s) { s.advanced.falloff = 0.5f; }},
      {"'hidden_occlusion' is", [](View&, OcclusionSettings& s) { s.hidden_occlusion = kNaN; }},
      {"'filter_tolerance_px' is",
       [](View&, OcclusionSettings& s) { s.advanced.filter_tolerance_px = 0.0f; }},
      {"'filter_tolerance_px' is",
       [](View&, OcclusionSettings& s) { s.advanced.filter_tolerance_px = kNaN; }},
      {"'filter_tolerance_px' is",
       [](View&, OcclusionSettings& s) { s.advanced.filter_tolerance_px = kInfinity; }},
      {"'filter_radius' is 4; it must be 0 to 3.",
       [](View&, OcclusionSettings& s) { s.advanced.filter_radius = 4; }},
      {"'history_frames' is 128; it must be 0 to 127.",
       [](View&, OcclusionSettings& s) { s.history_frames = 128; }},
      {"'clamp_width' is", [](View&, OcclusionSettings& s) { s.advanced.clamp_width = -1.0f; }},
      {"'clamp_width' is", [](View&, OcclusionSettings& s) { s.advanced.clamp_width = kNaN; }},
      {"'roughness' is", [](View&, OcclusionSettings& s) { s.roughness = 1.1f; }},
      {"'roughness' is", [](View&, OcclusionSettings& s) { s.roughness = kNaN; }},
      {"'roughness_channel' is 4; it must be 0 to 3.",
       [](View&, OcclusionSettings& s) { s.roughness_channel = 4; }},
      {"'power' is", [](View&, OcclusionSettings& s) { s.power = 0.0f; }},
      {"'power' is", [](View&, OcclusionSettings& s) { s.power = kNaN; }},
      {"'intensity' is", [](View&, OcclusionSettings& s) { s.intensity = -1.0f; }},
      {"'intensity' is", [](View&, OcclusionSettings& s) { s.intensity = 17.0f; }},
      {"'depth_layers' is", [](View&, OcclusionSettings& s) { s.depth_layers = 0; }},
      {"'depth_layers' is", [](View&, OcclusionSettings& s) { s.depth_layers = 3; }},
      {"needs a texture of second depth", [](View&, OcclusionSettings& s) { s.depth_layers = 2; }},
      {"needs a texture of back-face depth",
       [](View&, OcclusionSettings& s) { s.advanced.thickness_unit = ThicknessUnit::back_faces; }},
  };
  for (const Case& bad : cases) {
    const std::string said = error_of(bad.spoil);
    EXPECT_THAT(said, HasSubstr(bad.names));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(BadInput, NumbersInErrorMessagesAreShortAndExactInEveryLocale) {
  const CommaLocale comma;
  struct Case {
    const char* says;
    Spoil spoil;
  };
  const std::vector<Case> cases{
      {"'radius' is -1e-07;", [](View&, OcclusionSettings& s) { s.radius = -1e-7f; }},
      {"'thickness' is -1.5;", [](View&, OcclusionSettings& s) { s.thickness = -1.5f; }},
      {"'hidden_occlusion' is 1.0000001;",
       [](View&, OcclusionSettings& s) { s.hidden_occlusion = 1.0000001f; }},
      {"'falloff' is 1e-09 with", [](View&, OcclusionSettings& s) { s.advanced.falloff = 1e-9f; }},
      {"'filter_tolerance_px' is -0.25;",
       [](View&, OcclusionSettings& s) { s.advanced.filter_tolerance_px = -0.25f; }},
      {"'clamp_width' is -1e+30;",
       [](View&, OcclusionSettings& s) { s.advanced.clamp_width = -1e30f; }},
      {"'roughness' is 1.1;", [](View&, OcclusionSettings& s) { s.roughness = 1.1f; }},
      {"'history_frames' is 256;", [](View&, OcclusionSettings& s) { s.history_frames = 256; }},
      {"'slices' is 1234567;", [](View&, OcclusionSettings& s) { s.slices = 1234567; }},
  };
  for (const Case& bad : cases) EXPECT_THAT(error_of(bad.spoil), HasSubstr(bad.says));
}

TEST_F(BadInput, InvalidProjectionMatrixIsReported) {
  const std::vector<std::function<void(Matrix&)>> spoils{
      [](Matrix& m) { m.fill(0.0f); },         [](Matrix& m) { m[0] = kNaN; },
      [](Matrix& m) { m[10] = kInfinity; },    [](Matrix& m) { m[5] = 0.0f; },
      [](Matrix& m) { m[11] = 1.0f; },  // the camera looks along +Z
      [](Matrix& m) { m[10] = m[14] = 0.0f; },  // all points have the same depth
      [](Matrix& m) { m[2] = 0.4f; },  // oblique near plane
      [](Matrix& m) { m[1] = 0.5f; },  // mixes x and y
  };
  for (const auto& spoil : spoils) {
    const std::string said =
        error_of([&](View& view, OcclusionSettings&) { spoil(view.clip_from_view); });
    EXPECT_THAT(said, HasSubstr("projection matrix"));
    EXPECT_PRED1(is_a_sentence, said);
  }
  expect_a_good_frame();
}

TEST_F(BadInput, ViewMatrixThatScalesOrIsNotFiniteIsReported) {
  for (const float bad : {0.0f, 2.0f, kNaN, kInfinity}) {
    const std::string said =
        error_of([&](View& view, OcclusionSettings&) { view.view_from_world[5] = bad; });
    EXPECT_THAT(said, HasSubstr("view_from_world"));
    EXPECT_PRED1(is_a_sentence, said);
  }
  EXPECT_THAT(error_of([](View& view, OcclusionSettings&) { view.view_from_world[13] = kNaN; }),
              HasSubstr("view_from_world"));
  expect_a_good_frame();
}

TEST_F(BadInput, TransposedProjectionMatrixIsReported) {
  for (const TestView& test : test_views()) {
    if (test.orthographic) continue;
    SCOPED_TRACE(test.name);
    const std::string said = error_of([&](View& view, OcclusionSettings&) {
      for (std::size_t i = 0; i < 16; ++i)
        view.clip_from_view[i] = test.view.clip_from_view[4 * (i % 4) + i / 4];
    });
    EXPECT_THAT(said, HasSubstr("transposed"));
    EXPECT_PRED1(is_a_sentence, said);
  }
}

TEST_F(BadInput, RawOcclusionWithWrongTileSizeSlicesOrImageSizeIsReported) {
  struct Case {
    const char* names;
    std::function<void(RawOcclusionTextures&, OcclusionSettings&)> spoil;
  };
  const std::vector<Case> cases{
      {"'tile_size' is 0;", [](RawOcclusionTextures& s, OcclusionSettings&) { s.tile_size = 0; }},
      {"'tile_size' is 3;", [](RawOcclusionTextures& s, OcclusionSettings&) { s.tile_size = 3; }},
      {"'tile_size' is 4294967295;",
       [](RawOcclusionTextures& s, OcclusionSettings&) { s.tile_size = ~0u; }},
      {"'slices' is 0;", [](RawOcclusionTextures& s, OcclusionSettings&) { s.slices = 0; }},
      {"'slices' is 65;", [](RawOcclusionTextures& s, OcclusionSettings&) { s.slices = 65; }},
      {"raw occlusion of 8x6",
       [](RawOcclusionTextures& s, OcclusionSettings&) { s.tile_size = 1; }},
      {"raw occlusion of 0x0",
       [](RawOcclusionTextures& s, OcclusionSettings&) { s.raw_occlusion = {}; }},
      {"raw occlusion of 8x6", [](RawOcclusionTextures& s, OcclusionSettings&) { s.lobe = true; }},
      {"bent-normal residuals of 16x12",
       [](RawOcclusionTextures& s, OcclusionSettings&) { s.bent.index = 0; }},
      {"'roughness' is", [](RawOcclusionTextures&, OcclusionSettings& s) { s.roughness = kNaN; }},
      {"'roughness_channel' is 4; it must be 0 to 3.",
       [](RawOcclusionTextures&, OcclusionSettings& s) { s.roughness_channel = 4; }},
  };
  const Drawing drawing = draw(test_views()[2], 16, 12, groove(0.8));
  for (const Case& bad : cases) {
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
      const framegraph::Texture depth = upload(graph, drawing.depth_ndc);  // has index 0
      const framegraph::Texture normals = upload(graph, drawing.normal_vs);
      OcclusionSettings search;
      search.tile_size = 2;
      search.bent_normal = true;
      const auto raw_occlusion = add_gtao(frame, {depth, normals, {.in_view_space = true}}, search);
      ASSERT_TRUE(raw_occlusion);
      RawOcclusionTextures spoilt = *raw_occlusion;
      OcclusionSettings settings;
      bad.spoil(spoilt, settings);
      const auto result = add_reconstruct(
          frame, {.raw_occlusion = spoilt, .depth_ndc = depth, .normals = normals}, settings);
      ASSERT_FALSE(result);
      EXPECT_THAT(result.error().message, HasSubstr(bad.names));
      EXPECT_PRED1(is_a_sentence, result.error().message);
      read_back(graph, depth);
    });
  }
  expect_a_good_frame();
}

TEST_F(BadInput, FrameInFlightSlotOutOfRangeIsReported) {
  const Drawing drawing = draw(test_views()[2], 16, 12, groove(0.8));
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    gpu().kernels().begin_frame(8);
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    const auto outputs = add_occlusion(frame, {upload(graph, drawing.depth_ndc)}, {});
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
    const auto kernels = Kernels::create(handles(), frames);
    ASSERT_FALSE(kernels) << frames;
    EXPECT_THAT(kernels.error().message, HasSubstr(std::to_string(frames) + " frames in flight"));
    EXPECT_PRED1(is_a_sentence, kernels.error().message);
  }
}

TEST_F(BadInput, InputImageWithoutPixelsIsReported) {
  std::string said;
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    const auto depth = graph.create_texture("empty depth", {VK_FORMAT_R32_SFLOAT, {}});
    const auto outputs = add_occlusion(frame, {depth}, {});
    said = outputs ? "" : outputs.error().message;
    return {};
  });
  EXPECT_THAT(said, HasSubstr("no pixels"));
  EXPECT_PRED1(is_a_sentence, said);
  // The graph in which the invalid texture was declared is refused too.
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error(), HasSubstr("'empty depth'"));
  expect_a_good_frame();
}

TEST_F(BadInput, InputImagesOfDifferentSizesAreReported) {
  const Drawing drawing = draw(test_views()[2], 16, 12, groove(0.8));
  const Drawing small = draw(test_views()[2], 16, 11, groove(0.8));
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    const framegraph::Texture depth = upload(graph, drawing.depth_ndc);
    const auto normals = add_occlusion(frame,
                                       {.depth_ndc = depth,
                                        .normals = upload(graph, small.normal_vs),
                                        .normal_convention = {.in_view_space = true}},
                                       {});
    ASSERT_FALSE(normals);
    EXPECT_THAT(normals.error().message, HasSubstr("normals of 16x11"));
    const auto motion =
        add_occlusion(frame, {.depth_ndc = depth, .motion = upload(graph, small.depth_ndc)}, {});
    ASSERT_FALSE(motion);
    EXPECT_THAT(motion.error().message, HasSubstr("motion vectors of 16x11"));
    OcclusionSettings by_back_faces;
    by_back_faces.advanced.thickness_unit = ThicknessUnit::back_faces;
    const auto back_faces =
        add_occlusion(frame, {.depth_ndc = depth, .back_depth_ndc = upload(graph, small.depth_ndc)},
                      by_back_faces);
    ASSERT_FALSE(back_faces);
    EXPECT_THAT(back_faces.error().message, HasSubstr("back-face depth of 16x11"));
    OcclusionSettings two_layers;
    two_layers.depth_layers = 2;
    const auto second = add_occlusion(
        frame, {.depth_ndc = depth, .second_depth_ndc = upload(graph, small.depth_ndc)},
        two_layers);
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message, HasSubstr("second depth of 16x11"));
    read_back(graph, depth);
  });
  expect_a_good_frame();
}

TEST_F(BadInput, MissingDepthImageIsReported) {
  std::string said;
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    const auto outputs = add_occlusion(frame, {}, {});
    ASSERT_FALSE(outputs);
    said = outputs.error().message;
  });
  EXPECT_PRED1(is_a_sentence, said);
  expect_a_good_frame();
}

}  // namespace
}  // namespace alcove::passes
