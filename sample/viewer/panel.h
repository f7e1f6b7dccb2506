#pragma once

#include <string>
#include <vector>

#include "alcove/framegraph/executor.h"
#include "gpu/gpu.h"
#include "viewer/view_state.h"

namespace alcove::sample {

// Moving averages of the times of a frame's passes over about twenty frames, so that the times can
// be read. The averages restart if the passes change.
class SmoothedTimes {
 public:
  void add(const std::vector<PassTime>& measured);
  const std::vector<PassTime>& passes() const { return passes_; }
  double total_ms() const;

 private:
  std::vector<PassTime> passes_;
};

// The information that the panel shows besides the ViewState.
struct PanelFacts {
  std::string device;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  SmoothedTimes times;
  framegraph::MemoryStatistics memory;
  std::string refusal;               // why the chosen settings are not drawn; empty if they are
  std::string message;               // the result of the last screenshot or dropped file
  OcclusionSettings first_settings;  // settings that a reset restores
};

// The mouse and the keys of the window, a line each, for the panel and for the program's help.
inline constexpr const char* kMouseAndKeys =
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

// Lays the panel out between Gui::begin() and Gui::end() and changes `state` as its widgets are
// moved. Returns true if the user asks for a screenshot.
[[nodiscard]] bool lay_out_panel(ViewState& state, const PanelFacts& facts);

// Moves the camera by the mouse, unless the mouse is over the panel.
void move_camera_by_mouse(Camera& camera);

}  // namespace alcove::sample
