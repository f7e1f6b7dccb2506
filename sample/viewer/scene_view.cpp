#include "viewer/scene_view.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "scene/environment.h"
#include "scene/framing.h"
#include "viewer/screenshot.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

ViewState first_state(const Session& session, std::optional<float> roughness) {
  ViewState state;
  state.camera = session.camera;
  state.settings = session.settings;
  state.roughness = roughness;
  return state;
}

}  // namespace

tl::expected<std::unique_ptr<SceneView>, std::string> SceneView::create(SceneViewRequest wanted) {
  std::unique_ptr<SceneView> made(new SceneView(std::move(wanted)));
  const SceneViewRequest& request = made->request_;
  auto window = Window::create({request.width, request.height}, request.title);
  if (!window) {
    return Failure(std::move(window.error()));
  }
  made->window_ = std::move(*window);
  auto session = request.open_session(Window::instance_extensions());
  if (!session) {
    return Failure(std::move(session.error()));
  }
  made->session_ = std::move(*session);
  const auto environment = load_environment(request.environment);
  if (!environment) {
    return Failure(environment.error());
  }
  Gpu& gpu = *made->session_.gpu;
  auto presenter = Presenter::create(gpu, *made->window_);
  if (!presenter) {
    return Failure(std::move(presenter.error()));
  }
  made->presenter_ = std::move(*presenter);
  const VkFormat format = made->presenter_->format();
  auto frame = SceneFrame::create(gpu, made->session_.scene, *environment, request.normals, format);
  if (!frame) {
    return Failure(std::move(frame.error()));
  }
  made->frame_ = std::move(*frame);
  auto gui = Gui::create(gpu, *made->window_, format);
  if (!gui) {
    return Failure(std::move(gui.error()));
  }
  made->gui_ = std::move(*gui);
  made->state_ = first_state(made->session_, request.roughness);
  made->good_ = {made->state_.settings, made->state_.roughness};
  made->facts_.first_settings = made->state_.settings;
  made->facts_.device = gpu.device().properties().deviceName;
  made->window_->show();
  return made;
}

SceneView::~SceneView() {
  if (presenter_) {
    presenter_->wait();
  }
}

tl::expected<void, std::string> SceneView::replace_scene(const std::string& file) {
  auto loaded = request_.load_session(file);
  if (!loaded) {
    return Failure(std::move(loaded.error()));
  }
  const auto environment = load_environment(request_.environment);
  if (!environment) {
    return Failure(environment.error());
  }
  presenter_->wait();
  auto frame = SceneFrame::create(*session_.gpu, loaded->scene, *environment, request_.normals,
                                  presenter_->format());
  if (!frame) {
    return Failure(std::move(frame.error()));
  }
  frame_ = std::move(*frame);
  session_.scene = std::move(loaded->scene);
  session_.camera = loaded->camera;
  session_.settings = loaded->settings;
  return {};
}

void SceneView::open(const std::string& file) {
  if (auto replaced = replace_scene(file); !replaced) {
    facts_.message = std::move(replaced.error());
    return;
  }
  state_.camera = session_.camera;
  state_.settings.radius = session_.settings.radius;
  state_.kept.radius = session_.settings.radius;
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
  if (camera.orthographic || !(glm::length(session_.scene.bounds_ws.high) < kFarthest)) {
    return camera;
  }
  for (const glm::vec3& corner : corners_of(session_.scene.bounds_ws)) {
    camera.far_plane = std::max(camera.far_plane, 1.01f * glm::distance(corner, camera.eye_ws));
  }
  return camera;
}

void SceneView::fit_radius() {
  const VkExtent2D size = presenter_->size();
  const double aspect = static_cast<double>(size.width) / std::max(size.height, 1u);
  const RadiusChoice choice = radius_for_view(session_.scene, state_.camera, aspect);
  state_.settings.radius = choice.radius;
  facts_.message = fmt::format("Radius {:.3g}: {}.", choice.radius, choice.reason);
}

void SceneView::take_keys() {
  if (ImGui::GetIO().WantTextInput) {
    return;  // a number is being typed
  }
  for (const int key : window_->pressed_keys()) {
    if (key >= GLFW_KEY_1 && key < GLFW_KEY_1 + static_cast<int>(kPictureNames.size())) {
      state_.picture = static_cast<Picture>(key - GLFW_KEY_1);
    }
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
  if (panel_shown_ && lay_out_panel(state_, facts_)) {
    take_screenshot();
  }
  gui_->end();
}

tl::expected<void, std::string> SceneView::draw_choice(const Choice& choice,
                                                       const HostBuffer* read_back) {
  ViewState state = state_;
  state.camera = camera_around_scene();
  state.settings = choice.settings;
  state.roughness = choice.roughness;
  auto report = presenter_->draw([&](Graph& graph, Texture target) {
    return frame_->declare(graph, target, state).map([&](Texture drawn) {
      drawn = gui_->add(graph, drawn);
      if (read_back != nullptr) {
        add_read_back(graph, drawn, *read_back);
      }
    });
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  frame_->advance();
  facts_.memory = report->memory;
  ++drawn_frames_;
  return {};
}

tl::expected<void, std::string> SceneView::draw_chosen(const HostBuffer* read_back) {
  const Choice chosen{state_.settings, state_.roughness};
  if (refused_ == chosen) {
    return draw_choice(good_, read_back);
  }
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

tl::expected<void, std::string> SceneView::draw_and_read() {
  const VkExtent2D size = presenter_->size();
  constexpr VkDeviceSize kTexelBytes = 4;
  auto buffer = HostBuffer::create(session_.gpu->device(), kTexelBytes * size.width * size.height,
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (!buffer) {
    return Failure(std::move(buffer.error()));
  }
  if (auto drawn = draw_chosen(buffer->get()); !drawn) {
    return drawn;
  }
  presenter_->wait();
  screenshot_ = screenshot(**buffer, size, presenter_->format());
  return {};
}

tl::expected<void, std::string> SceneView::write() {
  const auto file = write_screenshot(request_.screenshots, screenshot_);
  if (!file) {
    return Failure(file.error());
  }
  const std::string command = request_.command(
      {state_.camera, good_.settings, good_.roughness, screenshot_.width, screenshot_.height});
  std::cout << file->string() << "\n" << command << std::endl;
  window_->copy_to_clipboard(command);
  facts_.message = file->string() + " is written; the clipboard has: " + command;
  return {};
}

tl::expected<bool, std::string> SceneView::draw() {
  window_->poll();
  if (window_->is_closed()) {
    return false;
  }
  // Dropped files are handled before the frame acquires an image of the window: version 1.3.239 of
  // the validation layers crashes if a program waits for the device between acquiring an image and
  // submitting its use.
  if (const auto dropped = window_->take_dropped_files(); !dropped.empty()) {
    open(dropped.back());
  }
  const auto prepared = presenter_->prepare();
  if (!prepared) {
    return Failure(prepared.error());
  }
  if (!*prepared) {
    return true;
  }
  lay_out();
  auto drawn = std::exchange(wanted_, false) ? draw_and_read().and_then([&] { return write(); })
                                             : draw_chosen(nullptr);
  if (!drawn) {
    return Failure(std::move(drawn.error()));
  }
  state_.camera = orbited(state_.camera, request_.orbit);
  return true;
}

}  // namespace alcove::sample
