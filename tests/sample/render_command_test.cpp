#include "cli/render_command.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "cli/choose_camera.h"
#include "cli/settings.h"
#include "scene/builtin_scene.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

const Options kDefaults;

tl::expected<Options, Stop> parse(const std::vector<std::string>& arguments) {
  std::vector<const char*> texts;
  texts.reserve(arguments.size());
  for (const std::string& argument : arguments) texts.push_back(argument.c_str());
  return parse_options(static_cast<int>(texts.size()), texts.data());
}

Shot some_shot() {
  Shot shot;
  shot.camera.eye_ws = {-7.4f, 1.0f / 3.0f, 1e-7f};
  shot.camera.target_ws = {0.1f, 1.35f, -1.2f};
  shot.camera.up_ws = {0.0f, 0.0f, 1.0f};
  shot.camera.fov_y = glm::radians(60.0f);
  shot.camera.near_plane = 0.05f;
  shot.camera.far_plane = std::numeric_limits<float>::infinity();
  shot.camera.reversed_z = true;
  shot.settings = OcclusionSettings(ALCOVE_QUALITY_HIGH, 0.7f);
  shot.width = 641;
  shot.height = 359;
  shot.frames = 0;
  return shot;
}

void make_orthographic(Shot& shot, float near_plane, float far_plane) {
  shot.camera.orthographic = true;
  shot.camera.reversed_z = false;
  shot.camera.ortho_height = 3.3f;
  shot.camera.near_plane = near_plane;
  shot.camera.far_plane = far_plane;
}

// Checks that the parsed options render the same shot.
void expect_round_trip(const Options& options, const Shot& shot) {
  const std::vector<std::string> arguments = render_arguments(options, shot);
  SCOPED_TRACE(shell_line(arguments));
  const auto read = parse(arguments);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->command, Command::render);
  const auto given = [](const Options& o) {
    return std::tuple(o.scene, o.environment, o.device, o.materials.cut_blends,
                      o.materials.both_sides);
  };
  EXPECT_EQ(given(*read), given(options));
  EXPECT_EQ(read->view.frames, shot.frames > 0 ? shot.frames : shot.settings.history_frames);
  EXPECT_EQ(read->view.guard_band, shot.guard_band);
  EXPECT_EQ(read->view.normals, shot.normals);
  EXPECT_EQ(read->view.width, shot.width);
  EXPECT_EQ(read->view.height, shot.height);
  const Scene scene = builtin_scene();
  const auto settings = occlusion_settings(read->occlusion, 1.0f);
  ASSERT_TRUE(settings) << settings.error();
  EXPECT_EQ(*settings, shot.settings);
  const auto camera = choose_camera(read->view, ViewFinder(scene));
  ASSERT_TRUE(camera) << camera.error();
  const auto seen = [](const Camera& c) {
    return std::tuple(c.eye_ws, c.target_ws, c.up_ws, c.near_plane, c.far_plane, c.reversed_z,
                      c.orthographic, c.orthographic ? c.ortho_height : c.fov_y);
  };
  EXPECT_EQ(seen(*camera), seen(shot.camera));
  const std::vector<float> roughness =
      shot.roughness ? std::vector<float>{*shot.roughness} : std::vector<float>{};
  EXPECT_EQ(read->occlusion.roughness, roughness);
}

TEST(PrintedRenderCommand, PrintedCommandParsesBackToTheSameShotAndOptions) {
  // Each entry changes one thing of a perspective view.
  const std::vector<std::function<void(Options&, Shot&)>> changes{
      [](Options&, Shot&) {},
      [](Options& o, Shot&) { o.scene = "a scene's file.glb"; },
      [](Options& o, Shot&) { o.environment = "sky.exr"; },
      [](Options&, Shot& s) { s.normals = NormalSource::geometric; },
      [](Options& o, Shot&) { o.device = 3; },
      [](Options& o, Shot&) { o.materials.cut_blends = true; },
      [](Options& o, Shot&) { o.materials.both_sides = true; },
      [](Options&, Shot& s) { s.camera.reversed_z = false; },
      [](Options&, Shot& s) { s.guard_band = 10.0; },
      [](Options&, Shot& s) { s.frames = 1; },
      [](Options&, Shot& s) { s.frames = 2; },
      [](Options&, Shot& s) { s.settings.history_frames = 17; },
      [](Options&, Shot& s) { make_orthographic(s, 0.05f, 50.0f); },
      [](Options&, Shot& s) { make_orthographic(s, 0.0f, 50.0f); },
      [](Options&, Shot& s) { make_orthographic(s, -20.0f, -1.0f); }};
  for (const auto& change : changes) {
    Options options;
    Shot shot = some_shot();
    change(options, shot);
    expect_round_trip(options, shot);
  }
}

TEST(PrintedRenderCommand, EverySettingInAPrintedCommandParsesBackUnchanged) {
  Shot shot = some_shot();
  shot.roughness = 0.3f;
  OcclusionSettings& settings = shot.settings;
  settings.radius = 0.1f;
  settings.slices = 3;
  settings.steps = 7;
  settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  settings.thickness = 1.0f / 7.0f;
  settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  settings.hidden_occlusion = 0.123456789f;
  settings.tile_size = 4;
  settings.history_frames = 17;
  settings.bent_normal = true;
  settings.specular = ALCOVE_SPECULAR_TABLE;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  expect_round_trip(kDefaults, shot);
}

TEST(PrintedRenderCommand, PrintedCoordinatesFarFromTheOriginParseBackToTheSamePosition) {
  const glm::dvec3 origin(100000.0, -3.0, 2e7);
  for (const float value : {2.3f, -0.1f, 1e-7f, 12345.678f}) {
    for (int c = 0; c < 3; ++c) {
      const double typed = std::stod(coordinate_text(value, origin[c]));
      // The text gives the same float up to the rounding of a double at that distance.
      EXPECT_NEAR(typed - origin[c], value, 4e-9 + 6e-8 * std::abs(value));
    }
  }
  EXPECT_EQ(coordinate_text(2.3f, 100000.0), "100002.3");
}

TEST(PrintedRenderCommand, AnyFieldOfViewInAPrintedCommandParsesBackUnchanged) {
  Shot shot = some_shot();
  // The range of angles that a file's camera may have.
  for (const float fov_y : {2e-5f, 0.01f, 3.05f, 3.1f}) {
    shot.camera.fov_y = fov_y;
    const auto read = parse(render_arguments(kDefaults, shot));
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_FLOAT_EQ(*read->view.fov_y, fov_y);
  }
  for (float fov_y = 0.05f; fov_y < 2.9f; fov_y += 0.0717f) {
    shot.camera.fov_y = fov_y;
    const auto read = parse(render_arguments(kDefaults, shot));
    ASSERT_TRUE(read);
    // Some floats have no exact angle in degrees.
    EXPECT_FLOAT_EQ(*read->view.fov_y, fov_y);
  }
}

TEST(PrintedRenderCommand, PrintedCommandOfAnUnchangedPresetHasNoSetOption) {
  const std::string line = shell_line(render_arguments(kDefaults, some_shot()));
  EXPECT_NE(line.find("--quality high --radius 0.7"), std::string::npos) << line;
  EXPECT_EQ(line.find("--set"), std::string::npos) << line;
  EXPECT_NE(line.find("--fov-y 60 "), std::string::npos) << line;
}

TEST(PrintedRenderCommand, ArgumentsOfAPrintedCommandAreQuotedForTheShell) {
  EXPECT_EQ(shell_line({"alcove", "it's a file.glb", "", "$x"}),
            R"(alcove 'it'\''s a file.glb' '' '$x')");
}

TEST(Settings, FileOfRecommendedSettingsIsReadBackExceptForTheRadius) {
  OcclusionSettings written(ALCOVE_QUALITY_ULTRA, 3.0f);
  written.steps = 13;
  written.hidden_occlusion = 0.1f;
  const TemporaryFolder folder;
  const std::string file = folder.write("settings.txt", settings_text({written, 10.0}));
  const auto options = parse({"alcove", "render", "--settings", file, "--set", "slices=7"});
  ASSERT_TRUE(options) << options.error().text;
  written.radius = 0.5f;
  written.slices = 7;
  EXPECT_EQ(occlusion_settings(options->occlusion, 0.5f), written);
  const std::string with_radius = folder.write("radius.txt", std::string("radius = 2\n"));
  const auto wide = parse({"alcove", "render", "--settings", with_radius});
  ASSERT_TRUE(wide) << wide.error().text;
  EXPECT_EQ(occlusion_settings(wide->occlusion, 0.5f)->radius, 2.0f);
  EXPECT_EQ(radius_source(wide->occlusion), "the file of --settings");
  for (const auto& [text, reason] :
       {std::pair("steps = 1000\n", "steps"), {"", "names no setting"}}) {
    const std::string bad = folder.write("bad.txt", std::string(text));
    const auto wrong = parse({"alcove", "render", "--settings", bad});
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().text.find(reason), std::string::npos) << wrong.error().text;
  }
  const auto both = parse({"alcove", "render", "--settings", file, "--quality", "high"});
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().text,
            "--settings and --quality: give one, the file holds every setting of a preset");
}

TEST(Settings, ChangeWithoutEffectIsNamed) {
  const auto options =
      parse({"alcove", "render", "--set", "weighting=uniform", "--set", "slices=2"});
  ASSERT_TRUE(options) << options.error().text;
  const auto notes = ineffective_changes(options->occlusion, OcclusionSettings());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(notes[0].starts_with("--set weighting=uniform has no effect")) << notes[0];
  OcclusionSettings horizons;
  horizons.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  EXPECT_TRUE(ineffective_changes(options->occlusion, horizons).empty());
}

}  // namespace
}  // namespace alcove::sample
