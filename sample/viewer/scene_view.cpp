#include "viewer/scene_view.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <iostream>

#include "scene/framing.h"
#include "support/image_io.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

ViewState first_state(const Session& session, std::optional<float> roughness, double guard_band) {
  ViewState state;
  state.camera = session.camera;
  state.settings = session.settings;
  state.roughness = roughness;
  state.guard_band = guard_band;
  return state;
}

// Writes an image to view.png in the folder, or to view-2.png and so on if that file exists.
// Returns the path of the file. Creates the folder; an empty path is the current folder.
Result<std::filesystem::path> write_screenshot(const std::filesystem::path& folder,
                                               const Image<glm::vec3>& image) {
  if (!folder.empty()) ALCOVE_TRY_VOID(create_folder(folder));
  std::filesystem::path file = folder / "view.png";
  for (int i = 2; std::filesystem::exists(file); ++i)
    file = folder / ("view-" + std::to_string(i) + ".png");
  return write_png(file, image).map([&] { return file; });
}

}  // namespace

Result<std::unique_ptr<SceneView>> SceneView::create(SceneViewRequest wanted) {
  std::unique_ptr<SceneView> made(new SceneView(std::move(wanted)));
  const SceneViewRequest& request = made->request_;
  const auto print = [](const std::string& note) { std::cerr << "note: " << note << "\n"; };
  ALCOVE_TRY(made->environment_, load_environment(request.environment, print));
  ALCOVE_TRY(made->window_, Window::create({request.width, request.height}, request.title));
  ALCOVE_TRY(made->session_, request.open_session(Window::instance_extensions()));
  ALCOVE_TRY(made->presenter_, Presenter::create(*made->session_.gpu, *made->window_));
  ALCOVE_TRY_VOID(made->create_frame(made->session_.scene));
  ALCOVE_TRY(made->gui_,
             Gui::create(*made->session_.gpu, *made->window_, made->presenter_->format()));
  made->state_ = first_state(made->session_, request.roughness, request.guard_band);
  made->good_ = {made->state_.settings, made->state_.roughness};
  made->facts_.first_settings = made->state_.settings;
  made->facts_.device = made->gpu().device().properties().deviceName;
  made->window_->show();
  return made;
}

SceneView::~SceneView() {
  if (presenter_) presenter_->wait();
}

Result<void> SceneView::create_frame(const Scene& scene) {
  presenter_->wait();
  ALCOVE_TRY(frame_, SceneFrame::create(*session_.gpu, scene, environment_, request_.normals,
                                        presenter_->format()));
  return {};
}

Result<void> SceneView::replace_scene(const std::string& file) {
  ALCOVE_TRY(Session loaded, request_.load_session(file));
  ALCOVE_TRY_VOID(create_frame(loaded.scene));
  session_.scene = std::move(loaded.scene);
  session_.camera = loaded.camera;
  session_.settings = loaded.settings;
  return {};
}

void SceneView::open(const std::string& file) {
  if (auto replaced = replace_scene(file); !replaced) {
    facts_.message = std::move(replaced.error());
    return;
  }
  state_.camera = session_.camera;
  state_.settings.radius = session_.settings.radius;
  state_.saved.radius = session_.settings.radius;
  good_ = {state_.settings, state_.roughness};
  refused_.reset();
  facts_.first_settings = session_.settings;
  facts_.refusal.clear();
  facts_.message = file + " is shown.";
  window_->set_title("alcove: " + file);
}

Camera SceneView::camera_around_scene() const {
  Camera camera = state_.camera;
  constexpr float kFarthest = 1e12f;  // distances beyond have no squares of floats to compare
  if (camera.orthographic || !(glm::length(session_.scene.bounds_ws.high) < kFarthest))
    return camera;
  for (const glm::vec3& corner : corners_of(session_.scene.bounds_ws))
    camera.far_plane = std::max(camera.far_plane, 1.01f * glm::distance(corner, camera.eye_ws));
  return camera;
}

void SceneView::fit_radius() {
  const VkExtent2D size = presenter_->size();
  const double aspect = static_cast<double>(size.width) / std::max(size.height, 1u);
  const RadiusChoice choice = ViewFinder(session_.scene).radius(state_.camera, aspect);
  state_.settings.radius = choice.radius;
  facts_.message = fmt::format("Radius {:.3g}: {}.", choice.radius, choice.reason);
}

void SceneView::take_keys() {
  if (ImGui::GetIO().WantTextInput) return;  // a number is being typed
  for (const int key : window_->pressed_keys()) {
    if (key >= GLFW_KEY_1 && key < GLFW_KEY_1 + static_cast<int>(kPictureNames.size()))
      state_.picture = static_cast<Picture>(key - GLFW_KEY_1);
    switch (key) {
      case GLFW_KEY_HOME:
        state_.camera = session_.camera;
        break;
      case GLFW_KEY_R:
        state_.settings = facts_.first_settings;
        break;
      case GLFW_KEY_A:
        fit_radius();
        break;
      case GLFW_KEY_P:
        take_screenshot();
        break;
      case GLFW_KEY_H:
        panel_shown_ = !panel_shown_;
        break;
      case GLFW_KEY_ESCAPE:
        window_->close();
        break;
      default:
        break;
    }
  }
}

void SceneView::lay_out() {
  gui_->begin();
  take_keys();
  move_camera_by_mouse(state_.camera);
  facts_.width = presenter_->size().width;
  facts_.height = presenter_->size().height;
  facts_.times.add(presenter_->timings());
  if (state_.fits_budget && facts_.refusal.empty()) {
    state_.settings = fitter_.fit({sizeof(AlcoveBudget), state_.target_ms, 1, 2, 6, 12},
                                  presenter_->timings(), state_.settings);
  }
  if (panel_shown_ && lay_out_panel(state_, facts_)) take_screenshot();
  gui_->end();
}

Result<void> SceneView::draw_choice(const Choice& choice, ReadBack* read_back) {
  ViewState state = state_;
  state.camera = camera_around_scene();
  state.settings = choice.settings;
  state.roughness = choice.roughness;
  const auto declare = [&](Graph& graph, Texture target) -> Result<PassRange> {
    ALCOVE_TRY(Texture drawn, frame_->declare(graph, target, state));
    drawn = gui_->add(graph, drawn);
    if (read_back != nullptr) {
      read_back->add(graph, drawn, [this](const Texels& texels) { screenshot_ = rgb(texels); });
      ALCOVE_TRY_VOID(read_back->added());
    }
    return frame_->view_passes();
  };
  ALCOVE_TRY(const auto report, presenter_->draw(declare));
  frame_->advance();
  facts_.memory = report.memory;
  ++drawn_frames_;
  return {};
}

Result<void> SceneView::draw_chosen(ReadBack* read_back) {
  const Choice chosen{state_.settings, state_.roughness};
  if (refused_ == chosen) return draw_choice(good_, read_back);
  auto drawn = draw_choice(chosen, read_back);
  if (drawn) {
    good_ = chosen;
    refused_.reset();
    facts_.refusal.clear();
    return {};
  }
  refused_ = chosen;
  facts_.refusal = std::move(drawn.error());
  return draw_choice(good_, read_back);
}

Result<void> SceneView::draw_and_read() {
  ReadBack read_back(gpu().device());
  return draw_chosen(&read_back).map([&] {
    presenter_->wait();
    read_back.finish();
  });
}

Result<void> SceneView::write() {
  ALCOVE_TRY(const auto path, write_screenshot(request_.screenshots, screenshot_));
  const std::string file = path.string();
  const std::string command = request_.command(
      {{screenshot_.width, screenshot_.height, request_.normals, 0, 0.0f, state_.guard_band},
       state_.camera,
       good_.settings,
       good_.roughness});
  std::cout << file << "\n" << command << std::endl;
  window_->copy_to_clipboard(command);
  facts_.message = file + " is written; the clipboard has: " + command;
  return {};
}

Result<bool> SceneView::draw() {
  window_->poll();
  if (window_->is_closed()) return false;
  // Dropped files are handled before the frame acquires an image of the window: version 1.3.239 of
  // the validation layers crashes if a program waits for the device between acquiring an image and
  // submitting its use.
  if (const auto dropped = window_->take_dropped_files(); !dropped.empty()) open(dropped.back());
  ALCOVE_TRY(const bool prepared, presenter_->prepare());
  if (!prepared) return true;
  lay_out();
  ALCOVE_TRY_VOID(std::exchange(wanted_, false) ? draw_and_read().and_then([&] { return write(); })
                                                : draw_chosen(nullptr));
  state_.camera = orbited(state_.camera, request_.orbit);
  return true;
}

}  // namespace alcove::sample
