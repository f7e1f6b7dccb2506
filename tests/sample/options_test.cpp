#include "cli/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace alcove::sample {
namespace {

using testing::HasSubstr;

tl::expected<Options, Stop> parse(const std::string& line) {
  std::vector<std::string> words{"alcove"};
  std::istringstream text(line);
  for (std::string word; text >> word;) words.push_back(word == "''" ? "" : word);
  std::vector<const char*> arguments;
  arguments.reserve(words.size());
  for (const std::string& word : words) arguments.push_back(word.c_str());
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, CommandsHaveTheirOwnDefaults) {
  EXPECT_EQ(parse("render")->command, Command::render);
  EXPECT_TRUE(parse("render")->scene.empty());
  EXPECT_EQ(parse("render")->view.width, 960u);
  EXPECT_EQ(parse("render")->view.frames, 1u);
  EXPECT_EQ(parse("view scene.glb")->view.frames, 0u);
  EXPECT_TRUE(parse("view scene.glb")->out.empty());
  EXPECT_EQ(parse("motion")->view.frames, 48u);
  EXPECT_FALSE(parse("motion")->path);
  EXPECT_EQ(parse("report")->view.frames, 32u);
  EXPECT_EQ(parse("report")->clock, Clock::modelled);
}

TEST(Options, CommandLineWithManyOptionsIsParsed) {
  const auto options = parse(
      "compare scene.glb --eye -9,5.5,-0.4 --target 5,3.2,-0.3 --fov-y 60 --near 0.1 --far inf "
      "--radius 0.75 --normals geometric --quality high --set slices=2 --set steps=5 "
      "--roughness 0.1,0.3,0.6 --spp 512 --reversed-z --size 1x1 --size 320x200 --out x --lit "
      "--environment sky.exr");
  ASSERT_TRUE(options) << options.error().text;
  EXPECT_EQ(options->scene, "scene.glb");
  EXPECT_EQ(options->environment, "sky.exr");
  EXPECT_TRUE(options->lit);
  EXPECT_EQ(*options->view.eye, glm::dvec3(-9, 5.5, -0.4));
  EXPECT_EQ(options->view.reversed_z, true);
  EXPECT_TRUE(std::isinf(*options->view.far_plane));
  EXPECT_EQ(options->occlusion.quality, ALCOVE_QUALITY_HIGH);
  EXPECT_EQ(options->view.normals, NormalSource::geometric);
  EXPECT_EQ(options->occlusion.set.size(), 2u);
  EXPECT_EQ(options->occlusion.set[1].value, 5u);
  EXPECT_EQ(options->occlusion.roughness.size(), 3u);
  EXPECT_EQ(options->occlusion.spp, 512u);
  EXPECT_EQ(options->view.width, 320u) << "the last occurrence counts";
  EXPECT_EQ(options->out, "x");
}

TEST(Options, OptionsOfSingleCommandsAreParsed) {
  EXPECT_EQ(parse("view --frames 3")->view.frames, 3u);
  EXPECT_EQ(parse("motion --path dolly --frames 24")->path, MotionKind::dolly);
  EXPECT_EQ(parse("recommend step --budget-ms 0.5 --second-layer 0")->second_layer_ms, 0.0);
  EXPECT_EQ(parse("compare --guard-band 7.5")->view.guard_band, 7.5);
  EXPECT_EQ(parse("recommend --tolerance 0.05 --clock processor")->clock, Clock::processor);
  EXPECT_EQ(parse("report step corner")->scenes, (std::vector<std::string>{"step", "corner"}));
  EXPECT_EQ(*parse("render --ortho-height 4 --near -20 --far -0.5")->view.near_plane, -20.0f);
  EXPECT_EQ(*parse("render --fov-y 174.75")->view.fov_y, glm::radians(174.75f));
  for (const char* angle : {"360", "-360", "1e-3", "0"}) {
    EXPECT_EQ(parse(std::string("render --orbit ") + angle)->view.orbit,
              glm::radians(std::strtof(angle, nullptr)));
  }
  EXPECT_TRUE(parse("render --roughness 0.3,0.301"));
  // A line for compare serves render and graph.
  for (const char* command : {"render", "graph", "motion", "report", "recommend --tolerance 0.1"})
    EXPECT_TRUE(parse(std::string(command) + " --spp 16")) << command;
  EXPECT_TRUE(parse("graph --roughness 0.3"));
}

TEST(Options, MistakesAreRefusedInASentenceThatNamesTheOption) {
  const struct {
    const char* line;
    const char* sentence;  // a part of it
  } wrong[] = {
      {"", "name a command; see alcove --help"},
      {"paint --size 2x2", "there is no command paint; see alcove --help"},
      {"render --colour red", "--colour"},
      {"render --colour red", "; see alcove render --help"},
      {"render --size 0x540", "--size"},
      {"render --size 960", "--size"},
      {"render --size 99999x2", "--size"},
      {"render --radius 0", "--radius"},
      {"render --radius nan", "--radius"},
      {"render --radius -1", "--radius"},
      {"render --spp 0", "--spp"},
      {"render --frames 0", "--frames"},
      {"view --frames 0", "--frames"},
      {"render --fov-y 180", "--fov-y"},
      {"render --fov-y 0", "--fov-y"},
      {"render --eye 1,2", "--eye"},
      {"render --eye 1,2,nan", "--eye"},
      {"render --up 0,0,0", "--up"},
      {"render --near 0", "--near"},
      {"render --near -20", "--near -20: give"},
      {"render --far -20", "or --ortho-height"},
      {"render --far near", "--far"},
      {"render --near 5 --far 2", "--near"},
      {"render --near 1e-7 --far 1e-7", "--near 1e-07:"},
      {"render --ortho-height 0", "--ortho-height"},
      {"render --ortho-height 4 --near inf", "--near"},
      {"view --orbit 360.1", "--orbit 360.1: give an angle in degrees, -360 to 360"},
      {"view --orbit inf", "--orbit"},
      {"view --orbit nan", "--orbit"},
      {"render --set slices", "--set"},
      {"render --set slice=2", "slices"},
      {"render --set slices=99999999999", "--set slices=99999999999: give a whole number, 1 to 64"},
      {"render --set slices=-1", "a whole number, 1 to 64"},
      {"render --set slices=65", "a whole number, 1 to 64"},
      {"render --set hidden_occlusion=much", "a number"},
      {"render --set estimator=guess", "give horizons or connected"},
      {"render --roughness 2", "--roughness"},
      {"render --roughness 0.3,0.1,0.3", "0.3,0.1,0.3: give"},
      {"render --quality superb", "--quality"},
      {"render --normals none", "--normals"},
      {"render --out ''", "--out '': give the name of a folder, such as out"},
      {"view --out ''", "--out '': give the name of a folder, such as out"},
      {"report --clock sundial", "--clock"},
      {"motion --path spiral", "--path"},
      {"motion --frames 14", "--frames"},
      {"recommend", "--budget-ms"},
      {"recommend --tolerance 0.05 --budget-ms 1", "--budget-ms"},
      {"recommend --tolerance 0", "--tolerance"},
      {"recommend --budget-ms inf", "--budget-ms"},
      {"recommend --tolerance 1.5", "--tolerance 1.5: give an error above 0, at most 1"},
      {"recommend --tolerance 0.1 --out ''", "--out '': give the name of a file"},
      {"recommend --tolerance 0.1 --back-faces -1", "--back-faces"},
      {"render --guard-band 51", "a percentage of the image's height, 0 to 50"},
      {"render --settings .", "this is a folder"},
      {"render --settings /dev/null", "this is not a regular file"},
      // Options that contradict each other.
      {"render --reversed-z --standard-z", "--standard-z"},
      {"render --set radius=2 --radius 1", "--radius and --set radius: give one"},
      {"render --camera hall --eye 1,2,3", "--camera and --eye: give one"},
      {"view --roughness 0.1,0.2", "--roughness: give one value"},
      {"report --gpu ps4 --clock processor", "--gpu and --clock: give one"},
      // Options without effect on the command.
      {"view --spp 16", "--spp"},
      {"motion --roughness 0.3", "--roughness"},
      {"report --roughness 0.3", "--roughness"},
      {"recommend --tolerance 0.1 --roughness 0.3", "--roughness"},
  };
  for (const auto& [line, sentence] : wrong) {
    const auto options = parse(line);
    ASSERT_FALSE(options) << line;
    EXPECT_EQ(options.error().status, 2) << line;
    EXPECT_THAT(options.error().text, HasSubstr(sentence)) << line;
    EXPECT_EQ(options.error().text.find('\n'), std::string::npos) << line;
  }
}

TEST(Options, HelpOptionPrintsHelpInsteadOfRunningTheCommand) {
  const auto all = parse("--help");
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().status, 0);
  EXPECT_THAT(all.error().text, HasSubstr("compare"));
  const auto one = parse("render --help");
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().text, HasSubstr("Usage: alcove render "));
  EXPECT_THAT(one.error().text, HasSubstr("--radius"));
  EXPECT_EQ(parse("render --eye there --help").error().text, one.error().text)
      << "help comes before a mistake";
}

TEST(Options, HelpFitsAScreenAndHelpAllListsEveryOptionAndSetting) {
  for (const char* command :
       {"render", "compare", "motion", "report", "recommend", "graph", "view", "cost", "doctor"}) {
    std::istringstream help(parse(std::string(command) + " --help").error().text);
    int lines = 0;
    for (std::string line; std::getline(help, line); ++lines) EXPECT_LE(line.size(), 100u) << line;
    EXPECT_LE(lines, 50) << command;
    const std::string all = parse(std::string(command) + " --help-all").error().text;
    const bool has_settings = command != std::string_view("doctor");
    EXPECT_EQ(all.find("horizons or connected") != std::string::npos, has_settings) << command;
  }
  EXPECT_THAT(parse("compare --help").error().text, testing::Not(HasSubstr("--lit-points")));
  EXPECT_THAT(parse("compare --help-all").error().text, HasSubstr("--lit-points"));
}

TEST(Options, VersionOptionPrintsTheProgramNameAndAVersionNumber) {
  const auto version = parse("--version");
  ASSERT_FALSE(version);
  EXPECT_EQ(version.error().status, 0);
  EXPECT_THAT(version.error().text, testing::MatchesRegex("alcove [0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(Options, ErrorMessagesReplaceControlCharactersAndShortenLongArguments) {
  const auto options = parse("render --radius \x1b[31m" + std::string(5000, 'x'));
  ASSERT_FALSE(options);
  EXPECT_EQ(options.error().text.find('\x1b'), std::string::npos);
  EXPECT_LT(options.error().text.size(), 200u);
}

}  // namespace
}  // namespace alcove::sample
