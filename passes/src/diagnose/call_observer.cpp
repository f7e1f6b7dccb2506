#include "diagnose/call_observer.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace alcove::passes {
namespace {

// Engines compute one matrix in several ways, so matrices that differ by rounding count as equal.
bool same(std::span<const float, 16> a, std::span<const float, 16> b) {
  float largest = 0.0f;
  for (const float element : a) {
    largest = std::max(largest, std::abs(element));
  }
  for (std::size_t i = 0; i < 16; ++i) {
    if (!(std::abs(a[i] - b[i]) <= 1e-6f * largest)) {
      return false;
    }
  }
  return true;
}

bool same(const AlcoveCamera& a, const AlcoveCamera& b) {
  return same(a.clip_from_view, b.clip_from_view) && same(a.view_from_world, b.view_from_world);
}

}  // namespace

void CallObserver::observe(const AlcoveFrame& frame) {
  same_index_ = began_ && frame.index == index_ ? same_index_ + 1 : 0;
  index_ = frame.index;
  began_ = true;
  for (const AlcoveView& given : std::span(frame.views, frame.view_count)) {
    const auto known = std::ranges::find_if(
        views_, [&](const View& view) { return view.used && view.id == given.id; });
    if (known != views_.end()) {
      observe(*known, given);
      continue;
    }
    const auto place = std::ranges::find(views_, false, &View::used);
    if (place != views_.end()) {
      place->used = true;
      place->id = given.id;
      place->camera = given.camera;
    }
  }
}

void CallObserver::observe(View& view, const AlcoveView& given) {
  const bool reset = given.reset_history != VK_FALSE;
  view.reset.add(reset);
  if (!reset && given.settings->history_frames > 0) {
    const bool is_last = same(given.previous_camera, view.camera);
    const bool is_this = same(given.previous_camera, given.camera);
    const bool moved = !same(given.camera, view.camera);
    if (moved) {
      const bool another_projection =
          same(given.previous_camera.view_from_world, view.camera.view_from_world);
      view.previous_is_this.add(is_this);
      view.projection_is_another.add(!is_last && !is_this && another_projection);
      view.previous_is_another.add(!is_last && !is_this && !another_projection);
      view.static_in_motion.add(given.static_frames > 0);
    }
  }
  view.camera = given.camera;
}

std::string CallObserver::describe() const {
  std::string text;
  if (same_index_ + 1 >= Share::kSureFrames) {
    text += "AlcoveFrame::index has been " + std::to_string(index_) + " in " +
            std::to_string(same_index_ + 1) +
            " frames in a row; count it up, so that the noise averages out.\n";
  }
  for (const View& view : views_) {
    const auto say = [&](bool mistake, const char* sentence) {
      if (view.used && mistake) {
        text += "View " + std::to_string(view.id) + ": " + sentence + "\n";
      }
    };
    say(view.previous_is_this.always(),
        "previous_camera is this frame's camera in every frame in which the camera moves; give the "
        "camera that the view was last recorded with.");
    say(view.previous_is_another.always(),
        "previous_camera is never the camera that the view was last recorded with; store that one "
        "after each frame.");
    say(view.projection_is_another.always(),
        "previous_camera has the last frame's view_from_world but another clip_from_view; give the "
        "matrix that depth was drawn with, jitter included.");
    say(view.static_in_motion.always(),
        "static_frames is not 0 although the camera moves; it counts frames that show exactly "
        "the same.");
    say(view.reset.always(),
        "reset_history is set in every frame, so that no history accumulates; set it at cuts "
        "only.");
  }
  return text;
}

}  // namespace alcove::passes
