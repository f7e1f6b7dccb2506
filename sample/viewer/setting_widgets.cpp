#include "viewer/setting_widgets.h"

#include <imgui.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "render/setting_table.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;

// Each overload lays out the widget of one kind of setting. `unit` is what the range is in.
void widget(const SettingInfo& info, float& value, float unit) {
  ImGui::SliderFloat(info.name, &value, info.low * unit, info.high * unit, "%.3g",
                     unit == 1.0f ? ImGuiSliderFlags_None : ImGuiSliderFlags_Logarithmic);
}

void widget(const SettingInfo& info, std::uint32_t& value, float /*unit*/) {
  const auto low = static_cast<std::uint32_t>(info.low);
  const auto high = static_cast<std::uint32_t>(info.high);
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
  for_each_setting(settings, [&](const SettingInfo& info, auto& value) {
    ImGui::BeginDisabled(info.matters != nullptr && !info.matters(settings));
    widget(info, value, std::string_view(info.name) == "radius" ? radius : 1.0f);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
      ImGui::SetTooltip("%s", info.help);
    }
  });
}

}  // namespace alcove::sample
