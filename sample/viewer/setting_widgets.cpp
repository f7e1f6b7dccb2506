#include "viewer/setting_widgets.h"

#include <imgui.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using passes::SettingGroup;
using passes::SettingInfo;
using passes::SettingRange;

// Returns the range of a slider: the setting's range, or SettingInfo::slider if the range has no
// maximum.
SettingRange slider_range(const SettingInfo& info) {
  SettingRange range = std::isinf(info.range.maximum) ? info.slider : info.range;
  if (range.above_minimum) {
    range.minimum += 0.01f * (range.maximum - range.minimum);
  }
  return range;
}

// Each overload lays out the widget for one type of setting. The range is multiplied by `unit`.
void widget(const SettingInfo& info, float& value, float unit) {
  const SettingRange range = slider_range(info);
  ImGui::SliderFloat(info.name, &value, range.minimum * unit, range.maximum * unit, "%.3g",
                     unit == 1.0f ? ImGuiSliderFlags_None : ImGuiSliderFlags_Logarithmic);
}

void widget(const SettingInfo& info, std::uint32_t& value, float /*unit*/) {
  if (info.range.power_of_two) {
    if (ImGui::BeginCombo(info.name, std::to_string(value).c_str())) {
      for (std::uint32_t choice = 1; info.range.contains(choice); choice *= 2) {
        if (ImGui::Selectable(std::to_string(choice).c_str(), choice == value)) {
          value = choice;
        }
      }
      ImGui::EndCombo();
    }
    return;
  }
  const auto low = static_cast<std::uint32_t>(info.range.minimum);
  const auto high = static_cast<std::uint32_t>(info.range.maximum);
  ImGui::SliderScalar(info.name, ImGuiDataType_U32, &value, &low, &high, "%u");
}

void widget(const SettingInfo& info, bool& value, float /*unit*/) {
  ImGui::Checkbox(info.name, &value);
}

template <typename Choice>
void widget(const SettingInfo& info, Choice& value, float /*unit*/) {
  if (ImGui::BeginCombo(info.name, passes::name_of(value).data())) {
    for (std::size_t i = 0; i < passes::kNames<Choice>.size(); ++i) {
      const auto choice = static_cast<Choice>(i);
      if (ImGui::Selectable(passes::name_of(choice).data(), choice == value)) {
        value = choice;
      }
    }
    ImGui::EndCombo();
  }
}

}  // namespace

void lay_out_settings(OcclusionSettings& settings, float radius) {
  const auto lay_out = [&](bool advanced) {
    passes::for_each_setting(settings, [&](const SettingInfo& info, auto& value) {
      if ((info.group == SettingGroup::advanced) != advanced ||
          info.group == SettingGroup::surface) {
        return;
      }
      ImGui::BeginDisabled(info.matters != nullptr && !info.matters(settings));
      widget(info, value, std::string_view(info.name) == "radius" ? radius : 1.0f);
      ImGui::EndDisabled();
      if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::SetTooltip("%s", info.help);
      }
    });
  };
  lay_out(false);
  if (ImGui::TreeNode("Advanced")) {
    lay_out(true);
    ImGui::TreePop();
  }
}

}  // namespace alcove::sample
