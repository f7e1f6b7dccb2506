#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "alcove/passes/setting_names.h"
#include "support/mib.h"
#include "viewer/orbit_camera.h"
#include "viewer/setting_widgets.h"

namespace alcove::sample {
namespace {

const ImVec4 kRefused{1.0f, 0.45f, 0.35f, 1.0f};
constexpr const char* kKeys =
    "left drag     orbit\n"
    "right drag    pan (also middle drag)\n"
    "wheel         move closer or away\n"
    "1 to 9        choose the picture\n"
    "Home          return to the first view\n"
    "R             reset the settings\n"
    "A             fit the radius to the view\n"
    "P             screenshot and command\n"
    "H             show or hide the panel\n"
    "Escape        close\n"
    "drop a file   open a .gltf or .glb";

template <typename Choice, std::size_t size>
void combo(const char* label, Choice& value, const std::array<std::string_view, size>& names) {
  const auto now = static_cast<std::size_t>(value);
  if (ImGui::BeginCombo(label, names[now].data())) {
    for (std::size_t i = 0; i < size; ++i) {
      if (ImGui::Selectable(names[i].data(), i == now)) {
        value = static_cast<Choice>(i);
      }
    }
    ImGui::EndCombo();
  }
}

void lay_out_picture(ViewState& state, const PanelFacts& facts) {
  combo("picture", state.picture, kPictureNames);
  combo("compare with", state.comparison, kComparisonNames);
  if (state.comparison != Comparison::kNone) {
    ImGui::SliderFloat("split position", &state.split, 0.0f, 1.0f, "%.2f");
  }
  ImGui::BeginDisabled(!facts.refusal.empty());
  if (ImGui::Button("keep settings for comparison")) {
    state.kept = state.settings;
    state.comparison = Comparison::kKept;
  }
  ImGui::EndDisabled();
}

void lay_out_qualities(ViewState& state, const PanelFacts& facts) {
  for (std::size_t i = 0; i < passes::kNames<passes::Quality>.size(); ++i) {
    if (i > 0) {
      ImGui::SameLine();
    }
    const auto quality = static_cast<passes::Quality>(i);
    if (ImGui::Button(passes::name_of(quality).data())) {
      state.settings = passes::quality_settings(quality, state.settings.radius);
    }
  }
  if (ImGui::Button("reset settings (R)")) {
    state.settings = facts.first_settings;
  }
}

void lay_out_roughness(ViewState& state) {
  bool of_materials = !state.roughness;
  if (ImGui::Checkbox("roughness of materials", &of_materials)) {
    constexpr float kMiddle = 0.5f;
    state.roughness = of_materials ? std::nullopt : std::optional(kMiddle);
  }
  if (state.roughness) {
    ImGui::SliderFloat("roughness", &*state.roughness, 0.0f, 1.0f, "%.2f");
  }
}

bool section(const char* name) {
  return ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen);
}

// Lays out the choices at the left edge, as high as the window. Returns true if the user asks for a
// screenshot.
bool lay_out_choices(ViewState& state, const PanelFacts& facts) {
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({26.0f * unit, ImGui::GetIO().DisplaySize.y});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize;
  bool screenshot = false;
  if (ImGui::Begin("settings", nullptr, kFixed)) {
    ImGui::PushItemWidth(-11.0f * unit);
    if (!facts.refusal.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, kRefused);
      ImGui::TextWrapped("%s The picture shows the previous settings.", facts.refusal.c_str());
      ImGui::PopStyleColor();
    }
    if (!facts.message.empty()) {
      ImGui::TextWrapped("%s", facts.message.c_str());
    }
    if (section("picture")) {
      lay_out_picture(state, facts);
    }
    if (section("occlusion")) {
      lay_out_qualities(state, facts);
      lay_out_settings(state.settings, facts.first_settings.radius);
      lay_out_roughness(state);
    }
    if (section("screenshot")) {
      screenshot = ImGui::Button("screenshot and command (P)");
    }
    if (section("mouse and keys")) {
      ImGui::TextUnformatted(kKeys);
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
  return screenshot;
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

// Lays out times and memory in the upper right corner.
void lay_out_cost(const PanelFacts& facts) {
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x, 0.0f}, ImGuiCond_Always, {1.0f, 0.0f});
  if (ImGui::Begin("cost", nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted(facts.device.c_str());
    ImGui::Text("%ux%u, %.1f frames per second", facts.width, facts.height,
                static_cast<double>(ImGui::GetIO().Framerate));
    lay_out_times(facts.times);
    ImGui::Text("transient memory %.1f MiB (%.1f without aliasing)", mib(facts.memory.aliased),
                mib(facts.memory.unaliased));
    ImGui::Text("history          %.1f MiB", mib(facts.memory.history));
  }
  ImGui::End();
}

}  // namespace

bool lay_out_panel(ViewState& state, const PanelFacts& facts) {
  lay_out_cost(facts);
  return lay_out_choices(state, facts);
}

void move_camera_by_mouse(Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) {
    return;
  }
  const float height = std::max(io.DisplaySize.y, 1.0f);
  const glm::vec2 share(io.MouseDelta.x / height, io.MouseDelta.y / height);
  constexpr float kTurnOfHeight = glm::pi<float>();
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f)) {
    camera = turned(camera, kTurnOfHeight * share);
  }
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0.0f) ||
      ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0f)) {
    camera = panned(camera, share);
  }
  constexpr float kStep = 0.9f;
  if (io.MouseWheel != 0.0f) {
    camera = dollied(camera, std::pow(kStep, io.MouseWheel));
  }
}

}  // namespace alcove::sample
