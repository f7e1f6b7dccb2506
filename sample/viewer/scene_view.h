#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/read_back.h"
#include "render/session.h"
#include "scene/environment.h"
#include "support/result.h"
#include "viewer/budget_fitter.h"
#include "viewer/gui.h"
#include "viewer/panel.h"
#include "viewer/presenter.h"
#include "viewer/scene_frame.h"
#include "viewer/view_state.h"
#include "viewer/window.h"

namespace alcove::sample {

// The initial state of a window, and functions of the program that the window calls.
struct SceneViewRequest : ViewRequest {
  std::string title;
  std::optional<float> roughness;  // perceptual roughness of every surface; null: of its material
  std::filesystem::path environment;  // .exr; empty: the procedural sky
  std::filesystem::path screenshots;  // folder for screenshots; empty: the current folder
  // Loads the scene and opens a device with these instance extensions.
  std::function<Result<Session>(const std::vector<const char*>&)> open_session;
  // Loads another scene with a camera and settings for it. Opens no device.
  std::function<Result<Session>(const std::string& file)> load_session;
  // Returns the shell command that renders a view without a window.
  std::function<std::string(const Shot&)> command;
};

// A scene in a window. `alcove view` draws one frame after the other.
class SceneView {
 public:
  // Opens the window before it loads the scene, so that a missing display is reported at once.
  [[nodiscard]] static Result<std::unique_ptr<SceneView>> create(SceneViewRequest request);
  ~SceneView();

  // Processes input and draws a frame. If the window was closed, draws nothing and returns false.
  [[nodiscard]] Result<bool> draw();
  // The number of presented frames. It does not grow while the window is minimised.
  std::uint32_t drawn_frames() const { return drawn_frames_; }
  // Requests a screenshot: the next frame is also written to a file, and the program prints the
  // command that renders the same frame without a window.
  void take_screenshot() { wanted_ = true; }
  const Image<glm::vec3>& last_screenshot() const { return screenshot_; }
  // Shows or hides the panel.
  void show_panel(bool shown) { panel_shown_ = shown; }

  // Replaces the scene by the one in a file, with the file's default view. The chosen settings
  // stay, except the radius. If the file cannot be read, the current scene stays and the panel
  // shows the reason.
  void open(const std::string& file);

  ViewState& state() { return state_; }
  const PanelFacts& facts() const { return facts_; }
  Window& window() { return *window_; }
  const Gpu& gpu() const { return *session_.gpu; }
  const Scene& scene() const { return session_.scene; }

 private:
  // The choices that the passes may refuse.
  struct Choice {
    OcclusionSettings settings;
    std::optional<float> roughness;
    bool operator==(const Choice&) const = default;
  };

  explicit SceneView(SceneViewRequest request) : request_(std::move(request)) {}
  // Creates the passes that draw a scene. Waits for the frames of the previous scene.
  Result<void> create_frame(const Scene& scene);
  Result<void> replace_scene(const std::string& file);
  // Returns the camera with its far plane moved behind the whole scene, because the user may have
  // moved the camera away from it.
  Camera camera_around_scene() const;
  void fit_radius();  // to the current view
  void take_keys();
  void lay_out();
  // Copies the window's image to `read_back` unless it is null.
  Result<void> draw_choice(const Choice& choice, ReadBack* read_back);
  // Draws a frame with the chosen settings. If the passes refuse them, uses the last settings that
  // could be drawn.
  Result<void> draw_chosen(ReadBack* read_back);
  Result<void> draw_and_read();
  Result<void> write();

  SceneViewRequest request_;
  EnvironmentImage environment_;
  std::unique_ptr<Window> window_;  // outlives the members below
  Session session_;
  std::unique_ptr<Presenter> presenter_;
  std::unique_ptr<SceneFrame> frame_;
  std::unique_ptr<Gui> gui_;
  ViewState state_;
  Choice good_;                    // the last choice that could be drawn
  std::optional<Choice> refused_;  // the choice that the passes refuse; null if they accept it
  PanelFacts facts_;
  BudgetFitter fitter_;
  bool panel_shown_ = true;
  bool wanted_ = false;  // whether the next frame is a screenshot
  Image<glm::vec3> screenshot_;
  std::uint32_t drawn_frames_ = 0;
};

}  // namespace alcove::sample
