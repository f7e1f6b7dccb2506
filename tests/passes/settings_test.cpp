// Tests the defaults and ranges of the settings, and validate().
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <type_traits>

#include "alcove/passes/setting_table.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

static_assert(std::is_aggregate_v<OcclusionSettings>);

TEST(Settings, DefaultSettingsAreThoseOfTheMediumPreset) {
  const OcclusionSettings settings;
  EXPECT_EQ(settings, quality_settings(Quality::medium, settings.radius));
  EXPECT_EQ(settings.slices, 2u);
  EXPECT_EQ(settings.steps, 12u);
  EXPECT_EQ(settings.tile_size, 4u);
  EXPECT_EQ(settings.history_frames, 32u);
}

TEST(Settings, EveryPresetIsValidAndOnlyTheReferenceHasHorizonsAndNoFilter) {
  for (std::size_t i = 0; i < kNames<Quality>.size(); ++i) {
    const auto quality = static_cast<Quality>(i);
    const OcclusionSettings settings = quality_settings(quality, 1.0f);
    EXPECT_TRUE(validate(settings)) << name_of(quality);
    const bool reference = quality == Quality::reference;
    EXPECT_EQ(settings.estimator == Estimator::horizons, reference);
    EXPECT_EQ(filter_radius(settings), reference ? 0u : 2u);
  }
}

TEST(Settings, SettingNamesAreUniqueAndHelpTextsAreSentences) {
  std::set<std::string> names;
  const OcclusionSettings settings;
  for_each_setting(settings, [&](const SettingInfo& info, const auto&) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_THAT(info.help, testing::EndsWith("."));
  });
}

// Returns the error of validate() if the setting `name` has `value`, or an empty text if it is
// accepted.
template <typename Value>
std::string error_of(const std::string& name, Value value) {
  OcclusionSettings settings;
  for_each_setting(settings, [&](const SettingInfo& info, auto& field) {
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(field)>, Value>) {
      if (info.name == name) field = value;
    }
  });
  const auto good = validate(settings);
  return good ? "" : good.error().message;
}

template <typename Value>
void expect_accepted(const SettingInfo& info, Value value) {
  EXPECT_EQ(error_of(info.name, value), "") << info.name << " = " << value;
}

template <typename Value>
void expect_refused(const SettingInfo& info, Value value) {
  const std::string said = error_of(info.name, value);
  EXPECT_THAT(said, testing::StartsWith("The setting '" + std::string(info.name) + "' is "));
  EXPECT_THAT(said, HasSubstr("; it must be " + info.range.text() + "."));
}

TEST(Settings, ValidationEnforcesExactlyTheStatedRangeOfEachSetting) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  int numbers = 0;
  const OcclusionSettings settings;
  for_each_setting(settings, [&](const SettingInfo& info, const auto& field) {
    using Value = std::remove_cvref_t<decltype(field)>;
    const float minimum = info.range.minimum;
    const float maximum = info.range.maximum;
    if constexpr (std::is_same_v<Value, float>) {
      ++numbers;
      if (info.range.above_minimum) {
        expect_refused(info, minimum);
        expect_accepted(info, std::nextafter(minimum, kInfinity));
      } else {
        expect_accepted(info, minimum);
      }
      expect_refused(info, std::nextafter(minimum, -kInfinity));
      expect_refused(info, kInfinity);
      expect_refused(info, std::numeric_limits<float>::quiet_NaN());
      if (std::isinf(maximum)) {
        expect_accepted(info, std::numeric_limits<float>::max());
      } else {
        expect_accepted(info, maximum);
        expect_refused(info, std::nextafter(maximum, kInfinity));
      }
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      ++numbers;
      const auto least = static_cast<std::uint32_t>(minimum);
      const auto most = static_cast<std::uint32_t>(maximum);
      expect_accepted(info, least);
      expect_accepted(info, most);
      if (least > 0) expect_refused(info, least - 1);
      expect_refused(info, most + 1);
      expect_refused(info, ~0u);
      for (std::uint32_t value = least; info.range.power_of_two && value <= most; ++value) {
        const bool is_power = (value & (value - 1)) == 0;
        is_power ? expect_accepted(info, value) : expect_refused(info, value);
      }
    } else if constexpr (std::is_enum_v<Value>) {
      const std::size_t count = kNames<Value>.size();
      EXPECT_EQ(error_of(info.name, static_cast<Value>(count - 1)), "") << info.name;
      const std::string said = error_of(info.name, static_cast<Value>(count));
      EXPECT_THAT(said, testing::StartsWith("The setting '" + std::string(info.name) + "' is "));
      EXPECT_THAT(said, HasSubstr(names_text<Value>()));
    }
  });
  EXPECT_EQ(numbers, 12);
}

TEST(Settings, SliderRangesContainOnlyAcceptedValues) {
  const OcclusionSettings settings;
  for_each_setting(settings, [&](const SettingInfo& info, const auto& field) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, float>) {
      if (std::isinf(info.range.maximum)) {
        EXPECT_TRUE(info.range.contains(info.slider.minimum)) << info.name;
        EXPECT_LT(info.slider.minimum, info.slider.maximum) << info.name;
        EXPECT_TRUE(std::isfinite(info.slider.maximum)) << info.name;
      }
    }
  });
}

TEST(Settings, RangeTextsStateMinimumAndMaximumInWords) {
  EXPECT_EQ((SettingRange{.minimum = 1, .maximum = 64}).text(), "1 to 64");
  EXPECT_EQ((SettingRange{.minimum = 1, .maximum = 4, .power_of_two = true}).text(), "1, 2 or 4");
  EXPECT_EQ((SettingRange{.above_minimum = true}).text(), "above 0 and finite");
  EXPECT_EQ((SettingRange{}).text(), "at least 0 and finite");
  EXPECT_EQ((SettingRange{.maximum = 16, .above_minimum = true}).text(), "above 0 and at most 16");
}

}  // namespace
}  // namespace alcove::passes
