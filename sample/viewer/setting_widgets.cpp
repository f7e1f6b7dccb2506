#include "setting_widgets.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "setting_names.h"

namespace alcove::sample {
namespace {

using passes::Estimator;
using passes::OcclusionSettings;

struct About {
  std::string_view name;
  float low;
  float high;
  const char* help;
};

constexpr std::array<About, 20> kAbout{{
    {"radius", 0.05f, 10.0f, "Occluders beyond it do not count; scene units."},
    {"slices", 1, 64, "Directions searched in a pixel and frame."},
    {"steps", 2, 64, "Samples on each side of a slice."},
    {"estimator", 0, 0,
     "What stands behind an occluder's front: everything (horizons; heuristic lets them sink), or "
     "a "
     "thickness for each sample (bitmask) or for each connected surface (connected)."},
    {"weighting", 0, 0, "What a visible direction counts: by its cosine, or all alike."},
    {"thickness", 0.0f, 1.0f, "Of occluders, in its unit."},
    {"thickness_unit", 0, 0,
     "Parts of the radius or of the distance from the eye, or where the scene's back faces are."},
    {"fill", 0.0f, 1.0f, "How much of what is hidden behind occluders occludes too."},
    {"blend", 0.0f, 1.0f, "How far each lower sample pulls the horizon down (heuristic)."},
    {"falloff", 0.0f, 1.0f, "Last part of the radius, over which occluders fade."},
    {"divisor", 1, 4, "One search a frame in a block of so many pixels a side: 1, 2 or 4."},
    {"pattern", 0, 0, "How directions are spread over pixels and frames."},
    {"depth_mips", 1, 5, "Levels of the depth pyramid that far samples read."},
    {"filter_reach", 0, 3, "Blocks on each side that a pixel learns from; 0: no filter."},
    {"filter_tolerance_px", 0.1f, 8.0f,
     "How far from the tangent plane a neighbour still counts, in pixels."},
    {"history_frames", 0, 255, "Frames that are averaged; 0: no history."},
    {"clamp_width", 0.0f, 8.0f, "Deviations that history is held to; 0: free."},
    {"bent_normal", 0, 0, "Also the mean visible direction."},
    {"specular", 0, 0, "How specular occlusion is found."},
    {"precision", 0, 0, "Bits of the results."},
}};

const About& about(std::string_view name) {
  const auto found = std::ranges::find(kAbout, name, &About::name);
  return found == kAbout.end() ? kAbout.front() : *found;
}

bool has_effect(std::string_view name, const OcclusionSettings& settings) {
  const bool thick =
      settings.estimator == Estimator::bitmask || settings.estimator == Estimator::connected;
  if (name == "thickness" || name == "thickness_unit" || name == "fill") {
    return thick;
  }
  if (name == "blend") {
    return settings.estimator == Estimator::heuristic;
  }
  if (name == "falloff") {
    return !thick;
  }
  if (name == "filter_tolerance_px") {
    return settings.filter_reach > 0;
  }
  if (name == "clamp_width") {
    return settings.history_frames > 0;
  }
  return true;
}

// Each overload lays out the widget of one kind of setting. `unit` is what the range is in.
void widget(const char* name, float& value, float unit) {
  const About& of = about(name);
  ImGui::SliderFloat(name, &value, of.low * unit, of.high * unit, "%.3g",
                     unit == 1.0f ? ImGuiSliderFlags_None : ImGuiSliderFlags_Logarithmic);
}

void widget(const char* name, std::uint32_t& value, float /*unit*/) {
  const auto low = static_cast<std::uint32_t>(about(name).low);
  const auto high = static_cast<std::uint32_t>(about(name).high);
  ImGui::SliderScalar(name, ImGuiDataType_U32, &value, &low, &high, "%u");
}

void widget(const char* name, bool& value, float /*unit*/) { ImGui::Checkbox(name, &value); }

template <typename Choice>
void widget(const char* name, Choice& value, float /*unit*/) {
  if (ImGui::BeginCombo(name, name_of_choice(value).data())) {
    for (const auto& [choice, meaning] : choices(value)) {
      if (ImGui::Selectable(choice.data(), meaning == value)) {
        value = meaning;
      }
    }
    ImGui::EndCombo();
  }
}

}  // namespace

void lay_out_settings(OcclusionSettings& settings, float radius) {
  for_each_setting(settings, [&](const char* name, auto& value) {
    ImGui::BeginDisabled(!has_effect(name, settings));
    widget(name, value, std::string_view(name) == "radius" ? radius : 1.0f);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
      ImGui::SetTooltip("%s", about(name).help);
    }
  });
}

}  // namespace alcove::sample
