// Tests the table of settings, and that settings are checked, printed and read with it.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "alcove/alcove.h"
#include "alcove/passes/setting_table.h"
#include "comma_locale.h"

namespace alcove::passes {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using Kind = SettingInfo::Kind;

AlcoveSettings preset(AlcoveQuality quality = ALCOVE_QUALITY_MEDIUM) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  EXPECT_EQ(alcoveGetSettings(quality, 0.7f, &settings), ALCOVE_SUCCESS);
  return settings;
}

std::string print(const AlcoveSettings& settings) {
  std::string text(alcovePrintSettings(&settings, nullptr, 0) + 1, '\0');
  text.resize(alcovePrintSettings(&settings, text.data(), text.size()));
  return text;
}

// Reads `text` and returns the message, or an empty text if it was read.
std::string read(const std::string& text, AlcoveSettings& settings) {
  char message[ALCOVE_MAX_MESSAGE];
  const AlcoveResult result = alcoveReadSettings(text.data(), text.size(), &settings, message);
  EXPECT_EQ(result == ALCOVE_SUCCESS, message[0] == '\0');
  return message;
}

TEST(Settings, TableHasUniqueNamesSentencesOfHelpAndSliders) {
  std::set<std::string> names;
  for (const SettingInfo& info : setting_table()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_THAT(info.help, EndsWith("."));
    if (info.kind != Kind::real || !std::isinf(info.range.maximum)) continue;
    EXPECT_TRUE(info.range.contains(info.slider.minimum)) << info.name;
    EXPECT_LT(info.slider.minimum, info.slider.maximum) << info.name;
    EXPECT_TRUE(std::isfinite(info.slider.maximum)) << info.name;
  }
}

TEST(Settings, EveryPresetIsAccepted) {
  for (std::size_t i = 0; i < kQualityNames.size(); ++i)
    EXPECT_TRUE(validate(preset(static_cast<AlcoveQuality>(i)))) << kQualityNames[i];
}

// A test that fails prints the row that passes/README.md must have.
TEST(Settings, ReadmeHasTheRowOfEachSettingWithTheValuesOfThePresets) {
  std::ifstream file(ALCOVE_PASSES_README);
  const std::string readme(std::istreambuf_iterator<char>(file), {});
  for (const SettingInfo& info : setting_table()) {
    std::string row = std::string("| `").append(info.name) + "` | " + allowed_text(info) + " |";
    for (std::size_t i = 0; i < kQualityNames.size(); ++i) {
      const bool is_radius = info.offset == offsetof(AlcoveSettings, radius);
      const AlcoveSettings settings = preset(static_cast<AlcoveQuality>(i));
      row.append(" ").append(is_radius ? "" : setting_text(settings, info)).append(" |");
    }
    EXPECT_NE(readme.find(row + "\n"), std::string::npos) << row;
  }
}

// Returns the error of validate() if a setting has `value`, or an empty text if it is accepted.
template <typename Value>
std::string error_of(const SettingInfo& info, Value value) {
  AlcoveSettings settings = preset();
  set_setting(settings, info, value);
  const auto good = validate(settings);
  return good ? "" : good.error().message;
}

template <typename Value>
void expect_refused(const SettingInfo& info, Value value, const std::string& allowed) {
  const std::string sentence = error_of(info, value);
  EXPECT_THAT(sentence, StartsWith("The setting '" + std::string(info.name) + "' is "));
  EXPECT_THAT(sentence, HasSubstr("; it must be " + allowed + "."));
}

TEST(Settings, ValidationEnforcesExactlyTheStatedRangeOfEachSetting) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const SettingInfo& info : setting_table()) {
    SCOPED_TRACE(info.name);
    const auto& [minimum, maximum, above, power_of_two] = info.range;
    const std::string range = info.range.text();
    if (info.kind == Kind::real) {
      const float least = above ? std::nextafter(minimum, kInfinity) : minimum;
      const float most = std::isinf(maximum) ? std::numeric_limits<float>::max() : maximum;
      for (const float good : {least, most}) EXPECT_EQ(error_of(info, good), "");
      for (const float bad : {std::nextafter(least, -kInfinity), std::nextafter(most, kInfinity),
                              std::numeric_limits<float>::quiet_NaN()})
        expect_refused(info, bad, range);
    } else if (info.kind == Kind::whole) {
      const auto least = static_cast<std::uint32_t>(minimum);
      const auto most = static_cast<std::uint32_t>(maximum);
      for (std::uint32_t value = least; value <= most; ++value)
        if (!power_of_two || (value & (value - 1)) == 0)
          EXPECT_EQ(error_of(info, value), "");
        else
          expect_refused(info, value, range);
      if (least > 0) expect_refused(info, least - 1, range);
      for (const std::uint32_t bad : {most + 1, ~0u}) expect_refused(info, bad, range);
    } else if (info.choices.front() != "false") {  // every number is a bool of C
      const auto count = static_cast<std::uint32_t>(info.choices.size());
      EXPECT_EQ(error_of(info, count - 1), "");
      expect_refused(info, count, allowed_text(info));
    }
  }
}

TEST(Settings, RangeTextsStateMinimumAndMaximumInWords) {
  EXPECT_EQ((SettingRange{.minimum = 1, .maximum = 64}).text(), "1 to 64");
  EXPECT_EQ((SettingRange{.minimum = 1, .maximum = 4, .power_of_two = true}).text(), "1, 2 or 4");
  EXPECT_EQ((SettingRange{.above_minimum = true}).text(), "above 0 and finite");
  EXPECT_EQ((SettingRange{}).text(), "at least 0 and finite");
  EXPECT_EQ((SettingRange{.maximum = 16, .above_minimum = true}).text(), "above 0 and at most 16");
}

// Each printed value reads back as the same number.
TEST(Settings, EverySettingIsPrintedShortAndReadBackInEveryLocale) {
  const CommaLocale comma;
  AlcoveSettings expected = preset(ALCOVE_QUALITY_ULTRA);
  expected.thickness = 0.12345678f;
  expected.hidden_occlusion = 1e-7f;
  for (const SettingInfo& info : setting_table()) {
    SCOPED_TRACE(info.name);
    if (info.kind == Kind::choice)
      set_setting(expected, info, static_cast<std::uint32_t>(info.choices.size()) - 1);
    AlcoveSettings settings = preset(ALCOVE_QUALITY_LOW);
    EXPECT_EQ(read(print(expected), settings), "");
    EXPECT_EQ(std::memcmp(&settings, &expected, sizeof settings), 0);
  }
  const std::string text = print(expected);
  EXPECT_THAT(text, StartsWith("radius = 0.7\ntile_size = 2\n"));
  for (const char* line : {"\nthickness = 0.12345678\n", "\nhidden_occlusion = 1e-07\n"})
    EXPECT_THAT(text, HasSubstr(line));
  char little[8];
  EXPECT_EQ(alcovePrintSettings(&expected, little, sizeof little), text.size());
  EXPECT_EQ(std::string(little), text.substr(0, 7));
}

TEST(Settings, OnlyNamedSettingsAreChanged) {
  AlcoveSettings settings = preset(), expected = preset();
  EXPECT_EQ(read("", settings), "");
  EXPECT_EQ(read("\n  steps=9 \r\n\n\tstatic_noise = true", settings), "");
  expected.steps = 9;
  expected.static_noise = 1;
  EXPECT_EQ(print(settings), print(expected));
}

TEST(Settings, TextThatCannotBeReadIsReportedInASentenceAndChangesNothing) {
  const struct {
    std::string text;
    const char* part;
  } cases[] = {
      {"steps", "'steps' of the settings is not of the form 'name = value'"},
      {"{\"settings\": {}}", "not of the form"},
      {"step = 9", "There is no setting 'step'"},
      {std::string(5000, '\x01') + "=9", "There is no setting '????"},
      {"steps = 1", "'steps' is 1; it must be a whole number, 2 to 64"},
      {"steps = -9", "'steps' is -9"},
      {"steps = 9.5", "'steps' is 9.5"},
      {"steps = 99999999999999999999", "'steps' is 99999999999999999999"},
      {"tile_size = 3", "1, 2, 4 or 8"},
      {"thickness = nan", "'thickness' is nan"},
      {"thickness = 1e99", "'thickness' is 1e99"},
      {"estimator = magic", "horizons or connected"},
      {"half_resolution = 1", "false or true"},
      {"slices = 3\ntile_size = 1\nhalf_resolution = true", "tile_size of 1"},
  };
  for (const auto& [text, part] : cases) {
    AlcoveSettings settings = preset();
    const std::string sentence = read(text, settings);
    EXPECT_THAT(sentence, HasSubstr(part));
    EXPECT_THAT(sentence, EndsWith("."));
    EXPECT_EQ(print(settings), print(preset()));
  }
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    std::string text = print(preset(ALCOVE_QUALITY_CONSOLE));
    for (int change = 0; change < 3; ++change)
      text[random() % text.size()] = static_cast<char>(random());
    AlcoveSettings settings = preset();
    if (!read(text, settings).empty()) {
      EXPECT_EQ(print(settings), print(preset()));
    }
  }
}

TEST(Settings, MissingArgumentsAndUnknownSizesAreErrors) {
  AlcoveSettings settings = preset();
  char message[ALCOVE_MAX_MESSAGE];
  EXPECT_EQ(alcoveReadSettings(nullptr, 0, &settings, message), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(message, HasSubstr("no text"));
  EXPECT_EQ(alcoveReadSettings("", 0, nullptr, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  for (const float radius : {0.0f, -1.0f, std::nanf(""), HUGE_VALF})
    EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, radius, &settings), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetSettings(static_cast<AlcoveQuality>(kQualityNames.size()), 1.0f, &settings),
            ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, 1.0f, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(print(settings), print(preset()));
  settings.struct_size = 12;
  EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_LOW, 1.0f, &settings), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(read("", settings), HasSubstr("AlcoveSettings::struct_size is 12"));
  for (const AlcoveSettings* bad : {static_cast<const AlcoveSettings*>(&settings),
                                    static_cast<const AlcoveSettings*>(nullptr)}) {
    char text[64] = "before";
    EXPECT_EQ(alcovePrintSettings(bad, text, sizeof text), 0u);
    EXPECT_STREQ(text, "");
    EXPECT_EQ(alcoveGetConvergedFrames(bad), 0u);
  }
}

}  // namespace
}  // namespace alcove::passes
