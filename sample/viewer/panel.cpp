#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string_view>

#include "alcove/passes/setting_table.h"
#include "support/process_memory.h"
#include "viewer/orbit_camera.h"

namespace alcove::sample {
namespace {

using passes::SettingInfo;
using passes::SettingRange;

// Lays out a list of names, one for each enumerator.
template <typename Choice, typename Names>
void combo(const char* label, Choice& value, const Names& names) {
  const auto now = static_cast<std::size_t>(value);
  if (ImGui::BeginCombo(label, names[now].data())) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (ImGui::Selectable(names[i].data(), i == now)) value = static_cast<Choice>(i);
    ImGui::EndCombo();
  }
}

// Returns the range of a slider: the setting's range, or SettingInfo::slider if the range has no
// maximum.
SettingRange slider_range(const SettingInfo& info) {
  SettingRange range = std::isinf(info.range.maximum) ? info.slider : info.range;
  if (range.above_minimum) range.minimum += 0.01f * (range.maximum - range.minimum);
  return range;
}

// Lays out the widget of a setting. The range is multiplied by `unit`.
void widget(const SettingInfo& info, AlcoveSettings& settings, float unit) {
  if (info.kind == SettingInfo::Kind::real) {
    const SettingRange range = slider_range(info);
    auto value = passes::setting_value<float>(settings, info);
    ImGui::SliderFloat(info.name, &value, range.minimum * unit, range.maximum * unit, "%.3g",
                       unit == 1.0f ? ImGuiSliderFlags_None : ImGuiSliderFlags_Logarithmic);
    passes::set_setting(settings, info, value);
    return;
  }
  auto value = passes::setting_value<std::uint32_t>(settings, info);
  if (info.kind == SettingInfo::Kind::choice && info.choices.front() == "false") {
    bool on = value != 0;
    ImGui::Checkbox(info.name, &on);
    value = on ? 1 : 0;
  } else if (info.kind == SettingInfo::Kind::choice) {
    combo(info.name, value, info.choices);
  } else if (info.range.power_of_two) {
    if (ImGui::BeginCombo(info.name, std::to_string(value).c_str())) {
      for (std::uint32_t choice = 1; info.range.contains(choice); choice *= 2)
        if (ImGui::Selectable(std::to_string(choice).c_str(), choice == value)) value = choice;
      ImGui::EndCombo();
    }
  } else {
    const auto low = static_cast<std::uint32_t>(info.range.minimum);
    const auto high = static_cast<std::uint32_t>(info.range.maximum);
    ImGui::SliderScalar(info.name, ImGuiDataType_U32, &value, &low, &high, "%u");
  }
  passes::set_setting(settings, info, value);
}

const ImVec4 kRefused{1.0f, 0.45f, 0.35f, 1.0f};
void lay_out_picture(ViewState& state, const PanelFacts& facts) {
  combo("picture", state.picture, kPictureNames);
  combo("compare with", state.comparison, kComparisonNames);
  if (state.comparison != Comparison::none)
    ImGui::SliderFloat("split position", &state.split, 0.0f, 1.0f, "%.2f");
  ImGui::BeginDisabled(!facts.refusal.empty());
  if (ImGui::Button("keep settings for comparison")) {
    state.saved = state.settings;
    state.comparison = Comparison::saved;
  }
  ImGui::EndDisabled();
}

// Lays out a widget for each setting, with its name in --set, its range, and its help as a tooltip.
// Settings that have no effect with the other settings are dimmed. Numbers that the user types
// (control and click) may be out of range; the passes refuse invalid ones. `radius` is the default
// radius of the scene, and scales the slider of the radius.
void lay_out_settings(OcclusionSettings& settings, float radius) {
  for (const SettingInfo& info : passes::setting_table()) {
    if (info.of_material) continue;
    ImGui::BeginDisabled(info.matters != nullptr && !info.matters(settings));
    widget(info, settings, std::string_view(info.name) == "radius" ? radius : 1.0f);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip("%s", info.help);
  }
  ImGui::Checkbox("bent_normal", &settings.bent_normal);
}

void lay_out_qualities(ViewState& state, const PanelFacts& facts) {
  for (std::size_t i = 0; i < passes::kQualityNames.size(); ++i) {
    const auto quality = static_cast<AlcoveQuality>(i);
    const char* const name = passes::kQualityNames.at(quality).data();
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(name).x + 2.0f * style.FramePadding.x;
    const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (i > 0 && ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
    if (ImGui::Button(name)) state.settings = OcclusionSettings(quality, state.settings.radius);
  }
  if (ImGui::Button("reset settings (R)")) state.settings = facts.first_settings;
}

// Lays out the time that slices and steps are fitted to.
void lay_out_budget(ViewState& state) {
  ImGui::Checkbox("fit slices and steps to a time", &state.fits_budget);
  if (state.fits_budget) {
    ImGui::SliderFloat("target ms", &state.target_ms, 0.05f, 200.0f, "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  }
}

void lay_out_roughness(ViewState& state) {
  bool of_materials = !state.roughness;
  if (ImGui::Checkbox("roughness of materials", &of_materials)) {
    constexpr float kMiddle = 0.5f;
    state.roughness = of_materials ? std::nullopt : std::optional(kMiddle);
  }
  if (state.roughness) ImGui::SliderFloat("roughness", &*state.roughness, 0.0f, 1.0f, "%.2f");
}

bool section(const char* name) {
  return ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen);
}

void lay_out_times(const SmoothedTimes& times) {
  const float unit = ImGui::GetFontSize();
  const double total = std::max(times.total_ms(), 1e-6);
  if (ImGui::BeginTable("times", 3, ImGuiTableFlags_SizingFixedFit)) {
    for (const PassTime& time : times.passes()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(time.pass.c_str());
      ImGui::TableNextColumn();
      ImGui::Text("%8.3f", time.milliseconds);
      ImGui::TableNextColumn();
      ImGui::ProgressBar(static_cast<float>(time.milliseconds / total),
                         {6.0f * unit, ImGui::GetTextLineHeight()}, "");
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted("total");
    ImGui::TableNextColumn();
    ImGui::Text("%8.3f ms", times.total_ms());
    ImGui::EndTable();
  }
}

void lay_out_cost(const PanelFacts& facts) {
  ImGui::TextUnformatted(facts.device.c_str());
  ImGui::Text("%ux%u, %.1f frames per second", facts.width, facts.height,
              static_cast<double>(ImGui::GetIO().Framerate));
  lay_out_times(facts.times);
  ImGui::Text("transient memory %.1f MiB (%.1f without aliasing)", mib(facts.memory.aliased),
              mib(facts.memory.unaliased));
  ImGui::Text("history          %.1f MiB", mib(facts.memory.history));
}

// Lays out the choices at the left edge, as high as the window, and the cost too if the window is
// narrow. Returns true if the user asks for a screenshot.
bool lay_out_choices(ViewState& state, const PanelFacts& facts, bool narrow) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({std::min(20.0f * unit, 0.5f * window.x), window.y});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize;
  bool screenshot = false;
  if (ImGui::Begin("settings", nullptr, kFixed)) {
    ImGui::PushItemWidth(-9.5f * unit);
    if (!facts.refusal.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, kRefused);
      ImGui::TextWrapped("%s The picture shows the previous settings.", facts.refusal.c_str());
      ImGui::PopStyleColor();
    }
    if (!facts.message.empty()) ImGui::TextWrapped("%s", facts.message.c_str());
    if (section("picture")) lay_out_picture(state, facts);
    if (section("occlusion")) {
      lay_out_qualities(state, facts);
      lay_out_budget(state);
      lay_out_settings(state.settings, facts.first_settings.radius);
      lay_out_roughness(state);
    }
    if (section("screenshot")) screenshot = ImGui::Button("screenshot and command (P)");
    if (narrow && section("cost")) lay_out_cost(facts);
    if (section("mouse and keys")) ImGui::TextUnformatted(kMouseAndKeys);
    ImGui::PopItemWidth();
  }
  ImGui::End();
  return screenshot;
}

// Lays out times and memory in the upper right corner.
void lay_out_corner(const PanelFacts& facts) {
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x, 0.0f}, ImGuiCond_Always, {1.0f, 0.0f});
  if (ImGui::Begin("cost", nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize))
    lay_out_cost(facts);
  ImGui::End();
}

}  // namespace

void SmoothedTimes::add(const std::vector<PassTime>& measured) {
  if (measured.empty()) return;
  if (!std::ranges::equal(measured, passes_, {}, &PassTime::pass, &PassTime::pass)) {
    passes_ = measured;
    return;
  }
  constexpr double kShare = 0.05;  // of the newest
  for (std::size_t i = 0; i < passes_.size(); ++i)
    passes_[i].milliseconds += kShare * (measured[i].milliseconds - passes_[i].milliseconds);
}

double SmoothedTimes::total_ms() const {
  double total = 0.0;
  for (const PassTime& time : passes_) total += time.milliseconds;
  return total;
}

bool lay_out_panel(ViewState& state, const PanelFacts& facts) {
  constexpr float kBesideEachOther = 52.0f;  // heights of the font; less is narrow
  const bool narrow = ImGui::GetIO().DisplaySize.x < kBesideEachOther * ImGui::GetFontSize();
  if (!narrow) lay_out_corner(facts);
  return lay_out_choices(state, facts, narrow);
}

void move_camera_by_mouse(Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const float height = std::max(io.DisplaySize.y, 1.0f);
  const glm::vec2 share(io.MouseDelta.x / height, io.MouseDelta.y / height);
  constexpr float kTurnOfHeight = glm::pi<float>();
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f))
    camera = turned(camera, kTurnOfHeight * share);
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0.0f) ||
      ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0f))
    camera = panned(camera, share);
  constexpr float kStep = 0.9f;
  if (io.MouseWheel != 0.0f) camera = dollied(camera, std::pow(kStep, io.MouseWheel));
}

}  // namespace alcove::sample
