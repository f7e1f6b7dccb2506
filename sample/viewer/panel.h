#pragma once

#include <string>

#include "alcove/framegraph/executor.h"
#include "viewer/smoothed_times.h"
#include "viewer/view_state.h"

namespace alcove::sample {

// What the panel tells.
struct PanelFacts {
  std::string device;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  SmoothedTimes times;
  framegraph::MemoryStatistics memory;
  std::string refusal;  // why the settings are not those that are drawn; empty: they are
  std::string message;  // what was done last
  passes::OcclusionSettings first_settings;  // that a reset goes back to
};

// Lays the panel out between Gui::begin() and Gui::end(), changes `state` as its widgets are moved,
// and says whether a screenshot is asked for.
[[nodiscard]] bool lay_out_panel(ViewState& state, const PanelFacts& facts);

// What the mouse does where it is not over the panel.
void move_camera_by_mouse(Camera& camera);

}  // namespace alcove::sample
