// Tests of the window. They need a display, which ctest starts for them, and run under the
// validation layers.
#include "cli/commands.h"

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "gltf_maker.h"
#include "render/frame_renderer.h"
#include "temporary_folder.h"
#include "viewer/scene_view.h"

namespace alcove::sample {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ViewerWindowTest : public testing::Test {
 protected:
  void SetUp() override {
    options_.command = Command::view;
    options_.view.width = 96;
    options_.view.height = 54;
    options_.validation = true;
    options_.out = folder_.path;
    open();
  }
  void TearDown() override {
    if (view_) expect_valid();
  }

  void expect_valid() const {
    const auto valid = check_validation(view_->gpu());
    ASSERT_TRUE(valid) << valid.error().substr(0, 600);
  }

  void open() {
    view_.reset();
    auto made = SceneView::create(scene_view_request(options_));
    ASSERT_TRUE(made) << made.error();
    view_ = std::move(*made);
  }

  // Draws until this many more frames are presented.
  void draw(std::uint32_t frames) {
    const std::uint32_t until = view_->drawn_frames() + frames;
    for (int i = 0; i < 1000 && view_->drawn_frames() < until; ++i) {
      const auto drawn = view_->draw();
      ASSERT_TRUE(drawn) << drawn.error();
      ASSERT_TRUE(*drawn);
    }
    ASSERT_EQ(view_->drawn_frames(), until);
  }

  const Image<glm::vec3>& draw_and_look() {
    view_->take_screenshot();
    draw(1);
    return view_->last_screenshot();
  }

  TemporaryFolder folder_;
  Options options_;
  std::unique_ptr<SceneView> view_;
};

bool is_plain(const Image<glm::vec3>& image) {
  return std::ranges::all_of(image.pixels,
                             [&](const glm::vec3& x) { return x == image.pixels.front(); });
}

TEST_F(ViewerWindowTest, EveryKindOfImageIsDrawnAloneAndBesideAComparisonImage) {
  view_->show_panel(false);
  for (std::size_t i = 0; i < kPictureNames.size(); ++i) {
    SCOPED_TRACE(kPictureNames[i]);
    view_->state().picture = static_cast<Picture>(i);
    for (const Comparison comparison : {Comparison::none, Comparison::horizons}) {
      view_->state().comparison = comparison;
      draw(1);
      const bool nothing_moves = view_->state().picture == Picture::motion;
      EXPECT_EQ(is_plain(draw_and_look()), nothing_moves && comparison == Comparison::none);
      EXPECT_EQ(view_->facts().refusal, "");
    }
  }
}

TEST_F(ViewerWindowTest, ShownImageAndSettingsMayChangeWhileFramesAreInFlight) {
  for (const std::uint32_t frames : {1, 2}) {
    for (std::size_t i = 0; i < kPictureNames.size(); ++i) {
      view_->state().picture = static_cast<Picture>(i);
      view_->state().comparison = static_cast<Comparison>(i % 2);
      view_->state().settings.history_frames = i % 3 == 0 ? 0 : 8;
      draw(frames);
      SCOPED_TRACE(kPictureNames[i]);
      ASSERT_NO_FATAL_FAILURE(expect_valid());
    }
  }
}

TEST_F(ViewerWindowTest, ShownVisibilityEqualsThatOfTheOffscreenRenderer) {
  view_->show_panel(false);
  view_->state().picture = Picture::visibility;
  const Image<glm::vec3> seen = draw_and_look();
  const ViewState& state = view_->state();
  const auto gpu = open_gpu({options_.device, options_.validation});
  ASSERT_TRUE(gpu) << gpu.error();
  const VkExtent2D size{seen.width, seen.height};
  const auto renderer = FrameRenderer::create(**gpu, view_->scene(),
                                              {size.width, size.height, options_.view.normals});
  ASSERT_TRUE(renderer) << renderer.error();
  FrameRequest request;
  request.view = gbuffer_view(state.camera, state.camera, size);
  request.occlusion = state.settings;
  const auto images = (*renderer)->draw_and_read(request);
  ASSERT_TRUE(images) << images.error();
  ASSERT_EQ(images->visibility.pixels.size(), seen.pixels.size());
  for (std::size_t i = 0; i < seen.pixels.size(); ++i)
    ASSERT_NEAR(seen.pixels[i].r, images->visibility.pixels[i], 0.003f) << "pixel " << i;
}

TEST_F(ViewerWindowTest, RenderedImageFollowsTheSizeOfTheWindow) {
  draw(2);
  for (const VkExtent2D size : {VkExtent2D{320, 200}, {97, 61}, {240, 135}}) {
    view_->window().resize(size);
    for (int i = 0; i < 100 && view_->facts().width != size.width; ++i) draw(1);
    EXPECT_EQ(view_->facts().width, size.width);
    EXPECT_EQ(view_->facts().height, size.height);
    EXPECT_FALSE(is_plain(draw_and_look()));
  }
}

TEST_F(ViewerWindowTest, InvalidSettingIsReportedAndAnImageStaysVisible) {
  view_->show_panel(false);
  draw(3);
  view_->state().settings.slices = 900;
  draw(3);
  EXPECT_THAT(view_->facts().refusal, HasSubstr("'slices' is 900"));
  EXPECT_FALSE(is_plain(draw_and_look()));
  view_->state().settings.slices = 2;
  draw(3);
  EXPECT_EQ(view_->facts().refusal, "");
}

TEST_F(ViewerWindowTest, ComparisonWithKeptSettingsMayUseBackFacesAndASecondDepthLayer) {
  ViewState& state = view_->state();
  state.saved = state.settings;
  state.saved.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  state.comparison = Comparison::saved;
  state.settings.depth_layers = 2;
  state.settings.specular = ALCOVE_SPECULAR_TABLE;
  draw(3);
  EXPECT_EQ(view_->facts().refusal, "");
}

TEST_F(ViewerWindowTest, ImagesAreDrawnWithAMovingCameraAndNormalsFromDepth) {
  options_.view.normals = NormalSource::depth;
  options_.view.orbit = 0.02f;
  ASSERT_NO_FATAL_FAILURE(open());
  for (const Picture picture : {Picture::bent_normal, Picture::lit, Picture::motion}) {
    view_->state().picture = picture;
    draw(3);
    EXPECT_FALSE(is_plain(draw_and_look()));
  }
}

TEST_F(ViewerWindowTest, PassTimesAndMemoryOfTheFrameAreReported) {
  draw(4);
  EXPECT_GT(view_->facts().times.total_ms(), 0.0);
  EXPECT_GT(view_->facts().memory.aliased, 0u);
}

// The view beside it and the lighting have passes of the same names.
TEST_F(ViewerWindowTest, PassesOfTheViewWithTheChosenSettingsAreMarkedInTheTimes) {
  options_.view.normals = NormalSource::depth;
  ASSERT_NO_FATAL_FAILURE(open());
  view_->state().picture = Picture::lit;
  view_->state().settings.specular = ALCOVE_SPECULAR_TABLE;
  view_->state().comparison = Comparison::saved;  // without specular occlusion by table
  draw(8);
  std::vector<std::string> of_view;
  std::size_t searches = 0;
  for (const PassTime& time : view_->facts().times.passes()) {
    if (time.of_view) of_view.push_back(time.pass);
    searches += time.pass == "gtao" ? 1 : 0;
  }
  EXPECT_THAT(of_view, ElementsAre("gtao", "reconstruct", "specular occlusion"));
  EXPECT_EQ(searches, 2u);
}

// The targets are out of reach on any device, so that no measured time decides.
TEST_F(ViewerWindowTest, SlicesAndStepsAreFittedToATime) {
  view_->state().settings.radius = 0.01f;
  view_->state().fits_budget = true;
  view_->state().target_ms = 1e-6f;
  draw(20);
  EXPECT_EQ(view_->state().settings.slices, 1u);
  EXPECT_EQ(view_->state().settings.steps, 6u);
  view_->state().target_ms = 1e9f;
  draw(20);
  EXPECT_EQ(view_->state().settings.slices, 2u);
  EXPECT_EQ(view_->state().settings.steps, 12u);
  EXPECT_EQ(view_->facts().refusal, "");
}

TEST_F(ViewerWindowTest, NoFrameIsDrawnAfterTheWindowIsClosed) {
  draw(1);
  view_->window().close();
  const auto drawn = view_->draw();
  ASSERT_TRUE(drawn) << drawn.error();
  EXPECT_FALSE(*drawn);
}

// Calls what GLFW calls when the user drops a file.
void drop(Window& window, const std::string& file) {
  const GLFWdropfun callback = glfwSetDropCallback(window.handle(), nullptr);
  glfwSetDropCallback(window.handle(), callback);
  ASSERT_NE(callback, nullptr);
  const char* paths[] = {file.c_str()};
  callback(window.handle(), 1, paths);
}

// Writes a triangle of 100 units around a point far from the origin.
std::string write_large_triangle(const TemporaryFolder& folder) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["materials"] = {{{"doubleSided", true}}};
  maker.primitive()["material"] = 0;
  maker.json["nodes"][0]["scale"] = {100, 100, 100};
  maker.json["nodes"][0]["translation"] = {4000, 0, 0};
  return folder.write("dropped.glb", maker.glb());
}

TEST_F(ViewerWindowTest, FileDroppedOnTheWindowReplacesSceneCameraAndRadius) {
  draw(2);
  const float radius = view_->state().settings.radius;
  drop(view_->window(), write_large_triangle(folder_));
  view_->show_panel(false);
  draw(1);
  EXPECT_EQ(view_->scene().name, "dropped");
  EXPECT_GT(view_->state().settings.radius, 4.0f * radius);
  view_->state().picture = Picture::normals;
  EXPECT_FALSE(is_plain(draw_and_look()));
}

TEST_F(ViewerWindowTest, SceneMayBeReplacedWhileFramesAreInFlight) {
  const std::string triangle = write_large_triangle(folder_);
  for (int i = 0; i < 6; ++i) {
    view_->state().picture = i % 2 == 0 ? Picture::lit : Picture::visibility;
    draw(static_cast<std::uint32_t>(i));
    drop(view_->window(), triangle);
    draw(1);
    ASSERT_EQ(view_->scene().name, "dropped");
    ASSERT_NO_FATAL_FAILURE(expect_valid());
  }
}

TEST_F(ViewerWindowTest, DroppedFileThatCannotBeReadIsReportedAndTheSceneStays) {
  draw(1);
  const std::string name = view_->scene().name;
  const Camera camera = view_->state().camera;
  drop(view_->window(), (folder_.path / "missing.glb").string());
  draw(2);
  EXPECT_EQ(view_->scene().name, name);
  EXPECT_EQ(view_->state().camera.eye_ws, camera.eye_ws);
  EXPECT_THAT(view_->facts().message, HasSubstr("missing.glb"));
}

}  // namespace
}  // namespace alcove::sample
