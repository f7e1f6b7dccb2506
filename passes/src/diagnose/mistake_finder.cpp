#include "diagnose/mistake_finder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "work/number_text.h"
#include "work/rigid_transform.h"

namespace alcove::passes {
namespace {

// Engines compute one matrix in several ways, so matrices that differ by rounding count as equal.
bool same(std::span<const float, 16> a, std::span<const float, 16> b) {
  float largest = 0.0f;
  for (const float element : a) largest = std::max(largest, std::abs(element));
  for (std::size_t i = 0; i < 16; ++i)
    if (!(std::abs(a[i] - b[i]) <= 1e-6f * largest)) return false;
  return true;
}

bool same(const AlcoveCamera& a, const AlcoveCamera& b) {
  return same(a.clip_from_view, b.clip_from_view) && same(a.view_from_world, b.view_from_world);
}

VkExtent2D read_size(const AlcoveView& view) {
  const AlcoveArea& read = view.info.read_area;
  const AlcoveImage& depth = view.images[ALCOVE_IMAGE_DEPTH];
  return read.width > 0 ? VkExtent2D{read.width, read.height}
                        : VkExtent2D{depth.width, depth.height};
}

maths::dvec3 eye_of(const AlcoveCamera& camera) {
  return maths::inverse(to_rigid(camera.view_from_world))[3];
}

}  // namespace

bool same_rotation(AlcoveCamera a, const AlcoveCamera& b) {
  std::copy_n(b.view_from_world + 12, 3, a.view_from_world + 12);
  return same(a.view_from_world, b.view_from_world);
}

const char* const MistakeFinder::kTooManyViews =
    "More views have a history than an engine could mean; give a view the same AlcoveViewInfo::id "
    "in every frame, and call alcoveDropView for one that is no longer drawn.";

MistakeFinder::View* MistakeFinder::find(std::uint32_t id) {
  const auto found =
      std::ranges::find_if(views_, [&](const View& view) { return view.used && view.id == id; });
  return found == views_.end() ? nullptr : &*found;
}

// Takes the place of the view that was not recorded for the longest time if there are too many.
MistakeFinder::View& MistakeFinder::create(const AlcoveView& given) {
  View& place = *std::ranges::min_element(views_, {}, [](const View& view) {
    return view.used ? std::uint64_t{view.last_frame} + 1 : 0;
  });
  is_new_ |= given.info.settings->history_frames > 0;
  too_many_views_ |= is_new_ && place.used && place.has_history;
  place = {.used = true, .id = given.info.id};
  return place;
}

void MistakeFinder::drop_view(std::uint32_t id) {
  if (View* const view = find(id)) {
    view->used = false;
    too_many_views_ = false;
    new_views_ = 0;
  }
}

void MistakeFinder::judge(View& view, const AlcoveView& given, std::uint32_t index) {
  const AlcoveViewInfo& info = given.info;
  const AlcoveSettings& settings = *info.settings;
  const auto note = [&](const Mistake& mistake, bool seen) { view.sightings.note(mistake, seen); };
  const bool reset = info.reset_history != VK_FALSE;
  const bool reads_index = settings.static_noise == 0 || settings.history_frames > 0;
  note(mistakes::index_repeats, reads_index && index == view.index);
  note(mistakes::index_goes_back, reads_index && index < view.index);
  note(mistakes::history_reset, reset);
  note(mistakes::resolution_changes, settings.half_resolution != view.half_resolution);
  if (reset || settings.history_frames == 0) return;
  // Two eyes: on a smooth path, the second difference of their places alternates along the camera's
  // x axis. It is twice the distance of the eyes, which is more than a camera trembles.
  const maths::dvec3 step = eye_of(info.camera) - view.eyes[0];
  const maths::dvec3 last_step = view.eyes[0] - view.eyes[1];
  const maths::dvec3 bend = step - last_step;
  const maths::dvec3 last_bend = last_step - (view.eyes[1] - view.eyes[2]);
  const maths::dmat4 axes = maths::transpose(to_rigid(info.camera.view_from_world));
  const double length = maths::length(bend);
  note(mistakes::eyes_alternate,
       length > 0.07 * settings.radius &&
           std::min(maths::length(step), maths::length(last_step)) > 0.01 * length &&
           maths::length(bend + last_bend) < 0.2 * length &&
           std::abs(maths::dot(bend, maths::dvec3(axes[0]))) > 0.9 * length);
  if (!same(info.camera, view.camera)) {
    const bool is_this = same(info.previous_camera, info.camera);
    const bool other_projection = same_rotation(info.previous_camera, view.camera);
    // The translation may differ: cameras may be relative to an origin that moves.
    const bool is_last =
        other_projection && same(info.previous_camera.clip_from_view, view.camera.clip_from_view);
    note(mistakes::previous_is_this, is_this);
    note(mistakes::projection_is_another, !is_last && !is_this && other_projection);
    note(mistakes::previous_is_another, !is_last && !is_this && !other_projection);
    note(mistakes::static_in_motion, info.static_frames > 0);
  }
  const VkExtent2D size = read_size(given);
  const bool resized = size.width != view.size.width || size.height != view.size.height;
  if (resized && info.largest_width > 0) {
    note(mistakes::previous_size_is_wrong,
         info.previous_width != view.size.width || info.previous_height != view.size.height);
  }
}

bool MistakeFinder::observe(const AlcoveFrame& frame) {
  ++frames_;
  is_new_ = false;
  for (const AlcoveView& given : std::span(frame.views, frame.view_count)) {
    View* view = find(given.info.id);
    if (view == nullptr)
      view = &create(given);
    else
      judge(*view, given, frame.index);
    view->last_frame = frames_;
    view->has_history = given.info.settings->history_frames > 0;
    view->index = frame.index;
    view->camera = given.info.camera;
    view->eyes = {eye_of(given.info.camera), view->eyes[0], view->eyes[1]};
    view->half_resolution = given.info.settings->half_resolution;
    view->sightings.begin_record();
    view->size = read_size(given);
  }
  new_views_ = static_cast<std::uint8_t>(new_views_ << 1 | (is_new_ ? 1 : 0));
  too_many_views_ |= new_views_ == 0xff;
  return too_many_views_ && !std::exchange(told_of_views_, true);
}

Sightings* MistakeFinder::sightings(std::uint32_t view_id) {
  View* const view = find(view_id);
  return view == nullptr ? nullptr : &view->sightings;
}

std::string MistakeFinder::describe() const {
  std::string text = too_many_views_ ? std::string(kTooManyViews) + "\n" : std::string();
  for (const View& view : views_) {
    for (const Sighting& sighting : view.sightings) {
      const auto& [mistake, seen, measure, last] = sighting;
      if (!view.used || mistake == nullptr || !view.sightings.is_recent(sighting) ||
          std::popcount(seen << (32 - mistake->frames)) < mistake->least)
        continue;
      std::string sentence = mistake->sentence;
      if (const std::size_t at = sentence.find('#'); at != std::string::npos) {
        // One digit, so that the sentence stays the same from frame to frame.
        const float unit = std::pow(10.0f, std::floor(std::log10(std::max(measure, 1e-3f))));
        sentence.replace(at, 1, number_text(std::round(measure / unit) * unit));
      }
      text += "View " + std::to_string(view.id) + ": " + sentence + "\n";
    }
  }
  return text;
}

}  // namespace alcove::passes
