#include "cli/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace alcove::sample {
namespace {

using testing::HasSubstr;

tl::expected<Options, Stop> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "alcove");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, RenderCommandWithoutOptionsUsesTheBuiltInSceneAt960By540) {
  const auto options = parse({"render"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->command, Command::render);
  EXPECT_TRUE(options->scene.empty());
  EXPECT_EQ(options->view.width, 960u);
  EXPECT_EQ(options->view.height, 540u);
}

TEST(Options, ViewCommandByDefaultHasNoFrameLimitAndNoOutputFolder) {
  const auto plain = parse({"view", "scene.glb"});
  ASSERT_TRUE(plain) << plain.error().text;
  EXPECT_EQ(plain->command, Command::view);
  EXPECT_EQ(plain->view.frames, 0u);
  EXPECT_TRUE(plain->out.empty());
  const auto told = parse({"view", "--frames", "3", "--out", "x", "--quality", "low"});
  ASSERT_TRUE(told) << told.error().text;
  EXPECT_EQ(told->view.frames, 3u);
  EXPECT_EQ(told->out, "x");
  EXPECT_FALSE(parse({"view", "--frames", "0"}));
}

TEST(Options, ClockOptionIsParsedAndUnknownClocksAreRefused) {
  EXPECT_EQ(parse({"report"})->clock, Clock::modelled);
  EXPECT_EQ(parse({"recommend", "--tolerance", "0.1", "--clock", "processor"})->clock,
            Clock::processor);
  const auto wrong = parse({"report", "--clock", "sundial"});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().text, HasSubstr("--clock"));
}

TEST(Options, CommandLineWithManyOptionsIsParsed) {
  const auto options =
      parse({"compare",  "scene.glb", "--eye",         "-9,5.5,-0.4", "--target",    "5,3.2,-0.3",
             "--fov-y",  "60",        "--near",        "0.1",         "--far",       "inf",
             "--radius", "0.75",      "--normals",     "geometric",   "--quality",   "high",
             "--set",    "slices=2",  "--set",         "steps=5",     "--roughness", "0.1,0.3,0.6",
             "--spp",    "512",       "--reversed-z",  "--size",      "320x200",     "--out",
             "x",        "--lit",     "--environment", "sky.exr"});
  ASSERT_TRUE(options) << options.error().text;
  EXPECT_EQ(options->scene, "scene.glb");
  EXPECT_EQ(options->environment, "sky.exr");
  EXPECT_TRUE(options->lit);
  EXPECT_EQ(*options->view.eye, glm::dvec3(-9, 5.5, -0.4));
  EXPECT_EQ(options->view.reversed_z, true);
  EXPECT_TRUE(std::isinf(*options->view.far_plane));
  EXPECT_EQ(options->occlusion.quality, passes::Quality::high);
  EXPECT_EQ(options->occlusion.normals, NormalSource::geometric);
  EXPECT_EQ(options->occlusion.set.size(), 2u);
  EXPECT_EQ(options->occlusion.set[1].second, "5");
  EXPECT_EQ(options->occlusion.roughness.size(), 3u);
  EXPECT_EQ(options->occlusion.spp, 512u);
  EXPECT_EQ(options->view.width, 320u);
  EXPECT_EQ(options->out, "x");
}

TEST(Options, InvalidOptionValuesAreRefusedInASentenceThatNamesTheOption) {
  const std::vector<std::vector<const char*>> wrong = {
      {"render", "--size", "0x540"},     {"render", "--size", "960"},
      {"render", "--size", "99999x2"},   {"render", "--radius", "0"},
      {"render", "--radius", "nan"},     {"render", "--radius", "-1"},
      {"render", "--spp", "0"},          {"render", "--frames", "0"},
      {"render", "--fov-y", "180"},      {"render", "--eye", "1,2"},
      {"render", "--eye", "1,2,nan"},    {"render", "--up", "0,0,0"},
      {"render", "--near", "0"},         {"render", "--far", "near"},
      {"render", "--set", "slices"},     {"render", "--roughness", "2"},
      {"render", "--quality", "superb"}, {"render", "--normals", "none"},
      {"render", "--ortho-height", "0"}};
  for (const auto& arguments : wrong) {
    const auto options = parse(arguments);
    ASSERT_FALSE(options) << arguments[1] << " " << arguments[2];
    EXPECT_EQ(options.error().status, 2);
    EXPECT_THAT(options.error().text, HasSubstr(arguments[1]));
    EXPECT_EQ(options.error().text.find('\n'), std::string::npos);
  }
}

TEST(Options, MotionCommandAcceptsACameraPathAndRefusesTooFewFrames) {
  const auto all = parse({"motion"});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->command, Command::motion);
  EXPECT_FALSE(all->path);
  EXPECT_EQ(all->view.frames, 48u);
  const auto one = parse({"motion", "--path", "dolly", "--frames", "24"});
  ASSERT_TRUE(one) << one.error().text;
  EXPECT_EQ(one->path, MotionKind::dolly);
  EXPECT_EQ(one->view.frames, 24u);
  EXPECT_EQ(parse({"render"})->view.frames, 1u);
  for (const auto& wrong : std::vector<std::vector<const char*>>{{"motion", "--path", "spiral"},
                                                                 {"motion", "--frames", "11"}}) {
    const auto options = parse(wrong);
    ASSERT_FALSE(options) << wrong[1];
    EXPECT_EQ(options.error().status, 2);
    EXPECT_THAT(options.error().text, HasSubstr(wrong[1]));
  }
}

TEST(Options, ReportCommandAcceptsAnyNumberOfScenes) {
  const auto none = parse({"report"});
  ASSERT_TRUE(none) << none.error().text;
  EXPECT_EQ(none->command, Command::report);
  EXPECT_TRUE(none->scenes.empty());
  EXPECT_EQ(none->view.frames, 32u);
  const auto two = parse({"report", "step", "corner", "--size", "64x64"});
  ASSERT_TRUE(two) << two.error().text;
  EXPECT_EQ(two->scenes, (std::vector<std::string>{"step", "corner"}));
}

TEST(Options, RecommendCommandNeedsEitherATimeBudgetOrAnErrorTolerance) {
  const auto time = parse({"recommend", "step", "--budget-ms", "0.5"});
  ASSERT_TRUE(time) << time.error().text;
  EXPECT_EQ(time->budget_ms, 0.5);
  EXPECT_FALSE(time->tolerance);
  EXPECT_EQ(parse({"recommend", "--tolerance", "0.05"})->tolerance, 0.05);
  for (const auto& wrong : std::vector<std::vector<const char*>>{
           {"recommend"},
           {"recommend", "--tolerance", "0.05", "--budget-ms", "1"},
           {"recommend", "--tolerance", "0"},
           {"recommend", "--budget-ms", "inf"}}) {
    const auto options = parse(wrong);
    ASSERT_FALSE(options);
    EXPECT_EQ(options.error().status, 2);
    EXPECT_THAT(options.error().text, HasSubstr(wrong.size() == 3 ? wrong[1] : "--budget-ms"));
  }
}

TEST(Options, NearPlaneOptionMustBeNearerThanTheFarPlane) {
  const auto options = parse({"render", "--near", "5", "--far", "2"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().text, HasSubstr("--near"));
  EXPECT_THAT(parse({"render", "--near", "1e-7", "--far", "1e-7"}).error().text,
              HasSubstr("--near 1e-07:"));
}

TEST(Options, OrthographicNearPlaneMayBeBehindTheEye) {
  const auto options = parse({"render", "--ortho-height", "4", "--near", "-20", "--far", "-0.5"});
  ASSERT_TRUE(options) << options.error().text;
  EXPECT_EQ(*options->view.near_plane, -20.0f);
  EXPECT_EQ(*options->view.far_plane, -0.5f);
  for (const char* plane : {"--near", "--far"}) {
    const auto perspective = parse({"render", plane, "-20"});
    ASSERT_FALSE(perspective);
    EXPECT_THAT(perspective.error().text, testing::StartsWith(std::string(plane) + " -20: give"));
    EXPECT_THAT(perspective.error().text, HasSubstr("--ortho-height"));
  }
  EXPECT_FALSE(parse({"render", "--ortho-height", "4", "--near", "inf"}));
}

TEST(Options, FieldOfViewOptionAcceptsVeryNarrowAndVeryWideAnglesButNotZero) {
  EXPECT_EQ(*parse({"render", "--fov-y", "174.75"})->view.fov_y, glm::radians(174.75f));
  EXPECT_EQ(*parse({"render", "--fov-y", "0.573"})->view.fov_y, glm::radians(0.573f));
  EXPECT_FALSE(parse({"render", "--fov-y", "0"}));
}

TEST(Options, OrbitOptionIsAtMostAFullRotationPerFrame) {
  for (const char* angle : {"360", "-360", "1e-3", "0"}) {
    const auto options = parse({"render", "--orbit", angle});
    ASSERT_TRUE(options) << options.error().text;
    EXPECT_EQ(options->view.orbit, glm::radians(std::strtof(angle, nullptr)));
  }
  for (const char* angle : {"360.1", "-361", "1e30", "-1e39", "inf", "-inf", "nan", "far"}) {
    const auto options = parse({"view", "--orbit", angle});
    ASSERT_FALSE(options) << angle;
    EXPECT_EQ(options.error().status, 2);
    EXPECT_EQ(options.error().text,
              "--orbit " + std::string(angle) + ": give an angle in degrees, -360 to 360");
  }
}

TEST(Options, LastOccurrenceOfARepeatedOptionCounts) {
  const auto options = parse({"render", "--size", "1x1", "--eye", "1,2,3", "--size", "640x360"});
  ASSERT_TRUE(options) << options.error().text;
  EXPECT_EQ(options->view.width, 640u);
}

TEST(Options, OptionsWithoutEffectOnTheCommandAreRefused) {
  EXPECT_FALSE(parse({"view", "--spp", "16"}));
  for (const char* command : {"render", "graph"})
    EXPECT_TRUE(parse({command, "--spp", "16"})) << "a line for compare serves " << command;
  for (const char* command : {"motion", "report"}) {
    EXPECT_TRUE(parse({command, "--spp", "16"})) << command;
    EXPECT_FALSE(parse({command, "--roughness", "0.3"})) << command;
  }
  EXPECT_FALSE(parse({"recommend", "--tolerance", "0.1", "--roughness", "0.3"}));
  EXPECT_TRUE(parse({"recommend", "--tolerance", "0.1", "--spp", "16"}));
  EXPECT_TRUE(parse({"graph", "--roughness", "0.3"}));
}

TEST(Options, RoughnessValuesThatWouldGiveTheSameFileNameAreRefused) {
  const auto options = parse({"render", "--roughness", "0.3,0.1,0.3"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().text, HasSubstr("0.3,0.1,0.3: give"));
  EXPECT_TRUE(parse({"render", "--roughness", "0.3,0.301"}));
}

TEST(Options, UnknownSettingsAndValuesOutOfRangeAreRefusedByTheParser) {
  const struct {
    const char* given;
    const char* wanted;
  } wrong[] = {{"slice=2", "slices"},
               {"slices=99999999999", "a whole number, 1 to 64"},
               {"slices=-1", "a whole number, 1 to 64"},
               {"slices=65", "a whole number, 1 to 64"},
               {"hidden_occlusion=much", "a number"},
               {"estimator=guess", "give horizons or connected"}};
  for (const auto& [given, wanted] : wrong) {
    const auto options = parse({"render", "--set", given});
    ASSERT_FALSE(options) << given;
    EXPECT_EQ(options.error().status, 2);
    EXPECT_THAT(options.error().text, testing::StartsWith("--set " + std::string(given) + ": "));
    EXPECT_THAT(options.error().text, HasSubstr(wanted));
  }
}

TEST(Options, HelpOptionPrintsHelpInsteadOfRunningTheCommand) {
  const auto all = parse({"--help"});
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().status, 0);
  EXPECT_THAT(all.error().text, HasSubstr("compare"));
  const auto one = parse({"render", "--help"});
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().text, HasSubstr("--radius"));
  const auto after_a_mistake = parse({"render", "--eye", "there", "--help"});
  ASSERT_FALSE(after_a_mistake);
  EXPECT_EQ(after_a_mistake.error().text, one.error().text);
}

TEST(Options, HelpOfACommandShowsItsUsage) {
  EXPECT_THAT(parse({"render", "--help"}).error().text, HasSubstr("Usage: alcove render "));
}

TEST(Options, HelpOfEveryCommandThatTakesSettingsListsTheSettings) {
  for (const char* command :
       {"render", "compare", "motion", "report", "recommend", "graph", "view"}) {
    const std::string help = parse({command, "--help"}).error().text;
    EXPECT_THAT(help, HasSubstr("hidden_occlusion")) << command;
    EXPECT_THAT(help, HasSubstr("horizons or connected")) << command;
  }
  EXPECT_THAT(parse({"doctor", "--help"}).error().text,
              testing::Not(HasSubstr("hidden_occlusion")));
}

TEST(Options, VersionOptionPrintsTheProgramNameAndAVersionNumber) {
  const auto version = parse({"--version"});
  ASSERT_FALSE(version);
  EXPECT_EQ(version.error().status, 0);
  EXPECT_THAT(version.error().text, testing::MatchesRegex("alcove [0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(Options, MissingOrUnknownCommandsAndUnknownOptionsAreRefused) {
  EXPECT_EQ(parse({}).error().status, 2);
  EXPECT_EQ(parse({"paint"}).error().status, 2);
  EXPECT_EQ(parse({"render", "--colour", "red"}).error().status, 2);
}

TEST(Options, ErrorMessagePointsToTheHelpOfTheCommand) {
  EXPECT_EQ(parse({"paint", "--size", "2x2"}).error().text,
            "there is no command paint; see alcove --help");
  EXPECT_EQ(parse({}).error().text, "name a command; see alcove --help");
  const std::string unknown = parse({"render", "--colour", "red"}).error().text;
  EXPECT_THAT(unknown, HasSubstr("--colour"));
  EXPECT_THAT(unknown, testing::EndsWith("; see alcove render --help"));
}

TEST(Options, EmptyNameOfTheOutputFolderIsRefused) {
  for (const char* command : {"render", "compare", "view"}) {
    const auto options = parse({command, "--out", ""});
    ASSERT_FALSE(options);
    EXPECT_EQ(options.error().text, "--out '': give the name of a folder, such as out");
  }
}

TEST(Options, ErrorMessagesReplaceControlCharactersAndShortenLongArguments) {
  const std::string text = "\x1b[31m" + std::string(5000, 'x');
  const auto options = parse({"render", "--radius", text.c_str()});
  ASSERT_FALSE(options);
  EXPECT_EQ(options.error().text.find('\x1b'), std::string::npos);
  EXPECT_LT(options.error().text.size(), 200u);
}

}  // namespace
}  // namespace alcove::sample
