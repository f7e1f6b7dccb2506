#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "render/normal_source.h"
#include "render/session.h"
#include "render/shot.h"
#include "viewer/gui.h"
#include "viewer/panel.h"
#include "viewer/presenter.h"
#include "viewer/scene_frame.h"
#include "viewer/view_state.h"
#include "viewer/window.h"

namespace alcove::sample {

// The first view of a window, and the functions of the program that it calls.
struct SceneViewRequest {
  std::uint32_t width = 960;  // of the window, pixels
  std::uint32_t height = 540;
  std::string title;
  float orbit = 0.0f;  // radians that the camera orbits its target by, per frame
  NormalSource normals = NormalSource::kShading;
  std::optional<float> roughness;     // perceptual, of every surface; none: of the materials
  std::filesystem::path environment;  // .hdr or .exr; empty: the procedural sky
  std::filesystem::path screenshots;  // folder for them; empty: the current one
  // Loads the scene and opens a device with these instance extensions.
  std::function<tl::expected<Session, std::string>(const std::vector<const char*>&)> open_session;
  // Loads another scene with a camera and settings of its own, and opens no device.
  std::function<tl::expected<Session, std::string>(const std::string& file)> load_session;
  // The shell command that draws a shot without a window.
  std::function<std::string(const Shot&)> command;
};

// A scene in a window: what `alcove view` runs, frame by frame.
class SceneView {
 public:
  // Opens the window before the scene is loaded: where there is no display, that is told first.
  [[nodiscard]] static tl::expected<std::unique_ptr<SceneView>, std::string> create(
      SceneViewRequest request);
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  // Takes in what the user did and draws a frame. False: the window is closed, nothing is drawn.
  [[nodiscard]] tl::expected<bool, std::string> draw();
  // Frames that were presented: none while the window is minimised.
  std::uint32_t drawn_frames() const { return drawn_frames_; }
  // Also writes the next frame to a file and prints the command that draws it without a window.
  void take_screenshot() { wanted_ = true; }
  const Image<glm::vec3>& last_screenshot() const { return screenshot_; }
  // Shows or hides the panel.
  void show_panel(bool shown) { panel_shown_ = shown; }

  // Shows another scene from its own first view, with the settings that are chosen and the radius
  // that suits it. If the file cannot be read, the scene stays and the panel says why.
  void open(const std::string& file);

  ViewState& state() { return state_; }
  const PanelFacts& facts() const { return facts_; }
  Window& window() { return *window_; }
  const Gpu& gpu() const { return *session_.gpu; }
  const Scene& scene() const { return session_.scene; }

 private:
  // The part of the state that the passes may refuse.
  struct Choice {
    passes::OcclusionSettings settings;
    std::optional<float> roughness;
    bool operator==(const Choice&) const = default;
  };

  explicit SceneView(SceneViewRequest request) : request_(std::move(request)) {}
  tl::expected<void, std::string> replace_scene(const std::string& file);
  // The camera with a far plane behind the scene, wherever the user has moved it.
  Camera camera_around_scene() const;
  void take_keys();
  void lay_out();
  // Where `read_back` is not null, the window's image goes there.
  tl::expected<void, std::string> draw_choice(const Choice& choice, const HostBuffer* read_back);
  // Falls back on the last choice that could be drawn.
  tl::expected<void, std::string> draw_chosen(const HostBuffer* read_back);
  tl::expected<void, std::string> draw_and_read();
  tl::expected<void, std::string> write();

  SceneViewRequest request_;
  std::unique_ptr<Window> window_;  // outlives what is on it
  Session session_;
  std::unique_ptr<Presenter> presenter_;
  std::unique_ptr<SceneFrame> frame_;
  std::unique_ptr<Gui> gui_;
  ViewState state_;
  Choice good_;                    // the last that could be drawn
  std::optional<Choice> refused_;  // the one that is chosen and cannot
  PanelFacts facts_;
  bool panel_shown_ = true;
  bool wanted_ = false;  // a screenshot
  Image<glm::vec3> screenshot_;
  std::uint32_t drawn_frames_ = 0;
};

}  // namespace alcove::sample
