#include "diagnose/mistake_finder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "work/number_text.h"

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

bool same_rotation(AlcoveCamera a, const AlcoveCamera& b) {
  std::copy_n(b.view_from_world + 12, 3, a.view_from_world + 12);
  return same(a.view_from_world, b.view_from_world);
}

constexpr std::array<const char*, kMistakes> kSentences{
#define ALCOVE_MISTAKE(name, sentence) sentence,
#include "diagnose/mistakes.inc"
#undef ALCOVE_MISTAKE
};

VkExtent2D read_size(const AlcoveView& view) {
  return view.info.read_area.width > 0
             ? VkExtent2D{view.info.read_area.width, view.info.read_area.height}
             : VkExtent2D{view.images[ALCOVE_IMAGE_DEPTH].width,
                          view.images[ALCOVE_IMAGE_DEPTH].height};
}

// `seen` has a bit for each frame that could show the mistake.
bool is_reported(Mistake mistake, std::uint32_t seen) {
  switch (mistake) {
    case Mistake::index_goes_back:  // once it may, for example when a game restarts
      return std::popcount(seen) >= 2;
    case Mistake::index_repeats:  // in every second record if a view is recorded twice a frame
      return std::popcount(seen & 0xffu) >= 3;
    case Mistake::history_reset:  // a film may have a cut or two
      return std::popcount(seen & 0xffffu) >= 3;
    case Mistake::eyes_alternate:  // a camera may tremble
      return (seen & 0xffu) == 0xffu;
    default:
      return std::popcount(seen & 0xffu) >= 5;
  }
}

std::array<float, 3> eye_of(const AlcoveCamera& camera) {
  const float* const m = camera.view_from_world;
  std::array<float, 3> eye{};
  for (std::size_t i = 0; i < 3; ++i)
    eye.at(i) = -(m[4 * i] * m[12] + m[4 * i + 1] * m[13] + m[4 * i + 2] * m[14]);
  return eye;
}

}  // namespace

const char* const MistakeFinder::kTooManyViews =
    "More views have a history than an engine could mean; give a view the same AlcoveViewInfo::id "
    "in "
    "every frame, and call alcoveDropView for one that is no longer drawn.";

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

Findings MistakeFinder::judge(const View& view, const AlcoveView& given, std::uint32_t index) {
  Findings result;
  const bool reset = given.info.reset_history != VK_FALSE;
  const bool reads_index =
      given.info.settings->static_noise == 0 || given.info.settings->history_frames > 0;
  result.set(Mistake::index_repeats, reads_index && index == view.index);
  result.set(Mistake::index_goes_back, reads_index && index < view.index);
  result.set(Mistake::history_reset, reset);
  if (reset || given.info.settings->history_frames == 0) return result;
  // Two steps in opposite directions.
  float both = 0.0f, step = 0.0f, last_step = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    const float now = eye_of(given.info.camera).at(i) - view.eyes[0].at(i);
    const float last = view.eyes[0].at(i) - view.eyes[1].at(i);
    both += now * last;
    step += now * now;
    last_step += last * last;
  }
  const float least = 1e-3f * given.info.settings->radius;
  result.set(Mistake::eyes_alternate, std::min(step, last_step) > least * least &&
                                          both < -0.7f * std::sqrt(step * last_step));
  if (!same(given.info.camera, view.camera)) {
    const bool is_this = same(given.info.previous_camera, given.info.camera);
    const bool other_projection = same_rotation(given.info.previous_camera, view.camera);
    // The translation may differ: cameras may be relative to an origin that moves.
    const bool is_last = other_projection && same(given.info.previous_camera.clip_from_view,
                                                  view.camera.clip_from_view);
    result.set(Mistake::previous_is_this, is_this);
    result.set(Mistake::projection_is_another, !is_last && !is_this && other_projection);
    result.set(Mistake::previous_is_another, !is_last && !is_this && !other_projection);
    result.set(Mistake::static_in_motion, given.info.static_frames > 0);
  }
  const VkExtent2D size = read_size(given);
  const bool resized = size.width != view.size.width || size.height != view.size.height;
  if (resized && given.info.largest_width > 0) {
    result.set(Mistake::previous_size_is_wrong, given.info.previous_width != view.size.width ||
                                                    given.info.previous_height != view.size.height);
  }
  return result;
}

bool MistakeFinder::observe(const AlcoveFrame& frame) {
  ++frames_;
  is_new_ = false;
  for (const AlcoveView& given : std::span(frame.views, frame.view_count)) {
    View* view = find(given.info.id);
    if (view == nullptr)
      view = &create(given);
    else
      observe(given.info.id, judge(*view, given, frame.index));
    view->last_frame = frames_;
    view->has_history = given.info.settings->history_frames > 0;
    view->index = frame.index;
    view->camera = given.info.camera;
    view->eyes = {eye_of(given.info.camera), view->eyes[0]};
    view->size = read_size(given);
  }
  new_views_ = static_cast<std::uint8_t>(new_views_ << 1 | (is_new_ ? 1 : 0));
  too_many_views_ |= new_views_ == 0xff;
  return too_many_views_ && !std::exchange(told_of_views_, true);
}

void MistakeFinder::observe(std::uint32_t view_id, const Findings& findings) {
  View* const view = find(view_id);
  for (std::size_t i = 0; view != nullptr && i < kMistakes; ++i) {
    if ((findings.judged >> i & 1u) != 0) {
      view->seen.at(i) =
          view->seen.at(i) << 1 | static_cast<std::uint32_t>(findings.seen >> i & 1u);
      view->measures.at(i) =
          (findings.seen >> i & 1u) != 0 ? findings.measures.at(i) : view->measures.at(i);
    }
  }
}

std::string MistakeFinder::describe() const {
  std::string text = too_many_views_ ? std::string(kTooManyViews) + "\n" : std::string();
  for (const View& view : views_) {
    for (std::size_t i = 0; view.used && i < kMistakes; ++i) {
      if (is_reported(static_cast<Mistake>(i), view.seen.at(i))) {
        std::string sentence = kSentences.at(i);
        if (const std::size_t at = sentence.find('#'); at != std::string::npos) {
          const float measure = view.measures.at(i);
          // One digit, so that the sentence stays the same from frame to frame.
          const float unit = std::pow(10.0f, std::floor(std::log10(std::max(measure, 1e-3f))));
          sentence.replace(at, 1, number_text(std::round(measure / unit) * unit));
        }
        text += "View " + std::to_string(view.id) + ": " + sentence + "\n";
      }
    }
  }
  return text;
}

}  // namespace alcove::passes
