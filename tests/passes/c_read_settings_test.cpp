// Tests of reading settings from JSON, and of the controller, through the C interface.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <string>

#include "alcove/passes/setting_table.h"
#include "c/settings.h"
#include "maths/random_input.h"

namespace alcove::passes {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

struct Settings {
  Settings() {
    EXPECT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.7f, &settings), ALCOVE_SUCCESS);
  }
  AlcoveResult read(const std::string& text) {
    return alcoveReadSettings(text.data(), text.size(), &settings, message.data());
  }
  std::string printed() const {
    std::string text(alcovePrintSettings(&settings, nullptr, 0) + 1, '\0');
    text.resize(alcovePrintSettings(&settings, text.data(), text.size()));
    return text;
  }
  std::string sentence() const { return message.data(); }

  AlcoveSettings settings{.struct_size = sizeof settings};
  std::array<char, ALCOVE_MAX_MESSAGE> message{};
};

template <typename Value>
std::string json_of(Value value) {
  if constexpr (std::is_enum_v<Value>)
    return '"' + std::string(name_of(value)) + '"';
  else if constexpr (std::is_same_v<Value, bool>)
    return value ? "true" : "false";
  else
    return std::to_string(value);
}

// Returns the file that `alcove recommend --out` writes: all but the radius and surfaces.
std::string file_of(const OcclusionSettings& settings) {
  std::string text = "{\n  \"settings\": {";
  const char* separator = "\n";
  for_each_setting(settings, [&](const SettingInfo& info, const auto& value) {
    if (info.group != SettingGroup::surface && std::string(info.name) != "radius") {
      text += separator + ("    \"" + std::string(info.name) + "\": " + json_of(value));
      separator = ",\n";
    }
  });
  return text + "\n  }\n}\n";
}

OcclusionSettings unusual_settings() {
  OcclusionSettings settings = quality_settings(Quality::ultra, 0.7f);
  settings.steps = 9;
  settings.thickness = 0.125f;
  settings.history_frames = 0;
  settings.static_noise = true;
  settings.half_resolution = true;
  settings.bent_normal = true;
  settings.specular = Specular::table;
  settings.precision = Precision::float16;
  settings.thickness_unit = ThicknessUnit::back_faces;
  settings.estimator = Estimator::horizons;
  return settings;
}

TEST(CReadSettings, EverySettingOfARecommendationIsRead) {
  const OcclusionSettings wanted = unusual_settings();
  Settings found;
  ASSERT_EQ(found.read(file_of(wanted)), ALCOVE_SUCCESS) << found.sentence();
  EXPECT_EQ(found.sentence(), "");
  Settings expected;
  expected.settings = from_settings(wanted);
  EXPECT_EQ(found.printed(), expected.printed());
}

TEST(CReadSettings, OnlyNamedSettingsChange) {
  Settings found;
  const std::string before = found.printed();
  for (const char* text :
       {"{\"settings\":{}}",
        " { \"other\" : [ { \"a\" : \"}\\\"\" } , 1.5e3 , null ] , \"settings\" : { } } ",
        "{\"settings\":{\"specular\":\"none\",\"bent_normal\":true}}"}) {
    EXPECT_EQ(found.read(text), ALCOVE_SUCCESS) << text << ": " << found.sentence();
    EXPECT_EQ(found.printed(), before) << text;
  }
  EXPECT_EQ(found.read("{\"settings\":{\"steps\":9}}"), ALCOVE_SUCCESS) << found.sentence();
  EXPECT_EQ(found.settings.steps, 9u);
  EXPECT_EQ(found.settings.radius, 0.7f);
}

TEST(CReadSettings, TextThatCannotBeUsedIsReportedInASentenceAndChangesNothing) {
  const std::string deep = "{\"a\":" + std::string(30000, '[') + std::string(30000, ']') + "}";
  const struct {
    std::string text;
    const char* part;
  } cases[] = {
      {"", "no settings"},
      {"{}", "no settings"},
      {"[]", "no settings"},
      {"settings", "no settings"},
      {"{\"settings\":3}", "no settings"},
      {"{\"settings\":{\"steps\":9}", "no settings"},
      {"{\"settings\":{\"steps\":9}}}", "no settings"},
      {"{\"settings\":{\"steps\":9,}}", "no settings"},
      {"{\"settings\":{\"steps\":[9]}}", "no settings"},
      {"{\"settings\":{\"steps\" 9}}", "no settings"},
      {"{\"settings\":{\"steps\":\"9", "no settings"},
      {"{\"settings\":{\"steps\\", "no settings"},
      {deep, "no settings"},
      {"{\"settings\":{}}" + std::string(70000, ' '), "no settings"},
      {"{\"settings\":{\"step\":9}}", "'step', which is no setting"},
      {"{\"settings\":{\"" + std::string(5000, '\x01') + "\":9}}", "which is no setting"},
      {"{\"settings\":{\"steps\":1}}", "'steps' is 1; it must be a whole number, 2 to 64"},
      {"{\"settings\":{\"steps\":-9}}", "'steps' is -9"},
      {"{\"settings\":{\"steps\":9.5}}", "'steps' is 9.5"},
      {"{\"settings\":{\"steps\":99999999999999999999}}", "'steps' is 99999999999999999999"},
      {"{\"settings\":{\"tile_size\":3}}", "1, 2, 4 or 8"},
      {"{\"settings\":{\"thickness\":nan}}", "'thickness' is nan"},
      {"{\"settings\":{\"thickness\":1e99}}", "'thickness' is 1e99"},
      {"{\"settings\":{\"estimator\":\"magic\"}}", "horizons or connected"},
      {"{\"settings\":{\"half_resolution\":1}}", "false or true"},
      {"{\"settings\":{\"tile_size\":1,\"half_resolution\":true}}", "tile_size of 1"},
  };
  for (const auto& [text, part] : cases) {
    Settings found;
    const std::string before = found.printed();
    EXPECT_EQ(found.read(text), ALCOVE_ERROR_INVALID_INPUT) << text.substr(0, 80);
    EXPECT_THAT(found.sentence(), HasSubstr(part)) << text.substr(0, 80);
    EXPECT_THAT(found.sentence(), EndsWith(".")) << text.substr(0, 80);
    EXPECT_EQ(found.printed(), before);
  }
}

TEST(CReadSettings, DamagedTextNeverChangesSettingsIfItIsRefused) {
  const std::string good = file_of(unusual_settings());
  maths_test::RandomInput random;
  for (std::size_t length = 0; length < good.size() - 2; ++length) {
    Settings found;
    EXPECT_EQ(found.read(good.substr(0, length)), ALCOVE_ERROR_INVALID_INPUT) << length;
  }
  for (int i = 0; i < 2000; ++i) {
    std::string text = good;
    for (int change = 0; change < 3; ++change)
      text[random.bits() % text.size()] = static_cast<char>(random.bits());
    Settings found;
    const std::string before = found.printed();
    if (found.read(text) != ALCOVE_SUCCESS) {
      EXPECT_EQ(found.printed(), before);
      EXPECT_THAT(found.sentence(), EndsWith("."));
    }
  }
}

TEST(CReadSettings, ArgumentsThatAreMissingAreReported) {
  Settings found;
  EXPECT_EQ(alcoveReadSettings(nullptr, 0, &found.settings, found.message.data()),
            ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(found.sentence(), HasSubstr("no text"));
  EXPECT_EQ(alcoveReadSettings("{}", 2, nullptr, nullptr), ALCOVE_ERROR_INVALID_INPUT);
}

// Returns another value of a setting than `value`, the `number`th that is tried.
template <typename Value>
Value another(Value value, std::uint32_t number) {
  if constexpr (std::is_same_v<Value, bool>)
    return !value;
  else if constexpr (std::is_enum_v<Value>)
    return static_cast<Value>((static_cast<std::size_t>(value) + number) % kNames<Value>.size());
  else if constexpr (std::is_same_v<Value, float>)
    return 0.1f + 0.25f * static_cast<float>(number);
  else
    return number;
}

TEST(CReadSettings, EachSettingGoesToCAndBack) {
  OcclusionSettings base;
  base.specular = Specular::slices;
  for_each_setting(base, [&](const SettingInfo& info, const auto&) {
    if (info.group == SettingGroup::output) return;
    int changes = 0;
    for (std::uint32_t number = 0; number < 5; ++number) {
      OcclusionSettings changed = base;
      for_each_setting(changed, [&](const SettingInfo& other, auto& field) {
        if (std::string_view(other.name) == info.name) field = another(field, number);
      });
      if (changed == base || changed.specular == Specular::none || !validate(changed)) continue;
      const AlcoveSettings in_c = from_settings(changed);
      const auto back = to_settings(&in_c);
      EXPECT_TRUE(back && *back == changed) << info.name;
      ++changes;
    }
    EXPECT_GT(changes, 0) << info.name;
  });
}

TEST(CFitBudget, SettingsChangeOnlyIfTheTimesAskForIt) {
  Settings view;
  const AlcoveBudget budget{sizeof budget, 2.0, 1, 2, 4, 12};
  std::array<double, 10> times{};
  std::uint32_t changed = 7;
  times.fill(1.9);
  ASSERT_EQ(alcoveFitBudget(&budget, times.data(), 10, &view.settings, &changed), ALCOVE_SUCCESS);
  EXPECT_EQ(changed, 0u);
  times.fill(4.0);
  ASSERT_EQ(alcoveFitBudget(&budget, times.data(), 10, &view.settings, &changed), ALCOVE_SUCCESS);
  EXPECT_EQ(changed, 1u);
  EXPECT_EQ(view.settings.slices, 1u);
  EXPECT_EQ(view.settings.steps, 10u) << "14 of 32 units of work, in 0.45 of the time";
  EXPECT_EQ(alcoveFitBudget(&budget, nullptr, 0, &view.settings, &changed), ALCOVE_SUCCESS);
  EXPECT_EQ(changed, 0u);
}

TEST(CFitBudget, ArgumentsThatCannotBeUsedAreRefused) {
  Settings view;
  AlcoveBudget budget{sizeof budget, 2.0, 1, 2, 4, 12};
  std::uint32_t changed = 0;
  const auto fit = [&] { return alcoveFitBudget(&budget, nullptr, 0, &view.settings, &changed); };
  EXPECT_EQ(fit(), ALCOVE_SUCCESS);
  EXPECT_EQ(alcoveFitBudget(nullptr, nullptr, 0, &view.settings, &changed),
            ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveFitBudget(&budget, nullptr, 1, &view.settings, &changed),
            ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveFitBudget(&budget, nullptr, 0, nullptr, &changed), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveFitBudget(&budget, nullptr, 0, &view.settings, nullptr),
            ALCOVE_ERROR_INVALID_INPUT);
  budget.target_ms = std::nan("");
  EXPECT_EQ(fit(), ALCOVE_ERROR_INVALID_INPUT);
  budget = {4, 2.0, 1, 2, 4, 12};
  EXPECT_EQ(fit(), ALCOVE_ERROR_INVALID_INPUT);
}

}  // namespace
}  // namespace alcove::passes
