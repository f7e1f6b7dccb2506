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

// Sentences that say what is wrong and what to do, in the order of Mistake. A # stands for
// Findings::measures.
constexpr std::array<const char*, kMistakes> kSentences{
    "AlcoveFrame::index stays the same from frame to frame; count it up, so that the noise "
    "averages out, or set static_noise if no temporal filter follows.",
    "AlcoveFrame::index goes back again and again; count it up, so that the noise averages out.",
    "previous_camera is this frame's camera in every frame in which the camera moves; give the "
    "camera that the view was last recorded with.",
    "previous_camera is not the camera that the view was last recorded with; store that one after "
    "each frame.",
    "previous_camera has the last frame's view_from_world but another clip_from_view; give the "
    "matrix that depth was drawn with, jitter included.",
    "previous_width and previous_height are not the size that the view was last recorded with; "
    "store it after each frame.",
    "static_frames is not 0 although the image changes; it counts frames that show exactly the "
    "same.",
    "reset_history is set in every frame, so that no history accumulates; set it at cuts only.",
    "AlcoveFrame::slot was recorded again before the device had finished its last frame; wait for "
    "the fence of the slot.",
    "an image is smaller than AlcoveImage::width and height say.",
    "the pixels fit the camera only if the whole image is in use, which is larger than "
    "AlcoveImage::width and height say; give the size of this frame.",
    "the size changes within an image of one size, and each change begins a new history; give "
    "largest_width and largest_height, and previous_width and previous_height.",
    "the image of depth holds values below 0 or above 1; give the depth buffer as the projection "
    "writes it, not a linear depth.",
    "the values of the image of depth have the steps of another format than AlcoveImage::format "
    "says; give the format that its view was created with.",
    "depth runs the other way than camera.clip_from_view says: the sky, or all that is seen, lies "
    "at its near plane; give the matrix that depth was drawn with.",
    "camera.clip_from_view looks like OpenGL's, with depth from -1 to 1: its near plane is a round "
    "number only then; convert it with ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE.",
    "camera.clip_from_view looks as if it had depth from 0 to 1 and was converted with "
    "ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE; convert it without that bit.",
    "the pixels fit another angle of view, or other near and far planes, than those of "
    "camera.clip_from_view; give the matrix that depth was drawn with.",
    "the pixels fit y of camera.clip_from_view the other way round; see "
    "ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP.",
    "the radius is less than a pixel almost everywhere; give it in the units of the scene.",
    "the radius is more than twice the height of the image everywhere; give it in the units of the "
    "scene.",
    "normals fit the depth in the other space; change normals_in_view_space.",
    "normals fit the depth when they are decoded in another way; change normal_encoding.",
    "normals fit the depth with the other sign of z; change normals_forward_z.",
    "the pixels fit camera.view_from_world only if it is inverted; give the matrix from world to "
    "view space.",
    "normals fit the depth under no reading, typically by # degrees: the image holds something "
    "else, or normals with other axes; or depth is not what camera.clip_from_view gives; or "
    "camera.view_from_world is not the camera's.",
    "the pixels fit the camera of the frame before or after: camera and depth are not of the same "
    "frame; give the camera that this frame's depth was drawn with.",
    "depth is shifted by jitter, typically by # pixels from frame to frame, that "
    "camera.clip_from_view lacks; give the matrix that depth was drawn with.",
    "camera.clip_from_view has a jitter, of # pixels from frame to frame, that depth was not drawn "
    "with; give the matrix that depth was drawn with.",
    "the jitter of camera.clip_from_view differs, by # pixels from frame to frame, from that of "
    "depth: it has another sign or unit, or is another frame's; give the matrix that depth was "
    "drawn with.",
    "depth of successive frames fits if the camera moves # times as far as camera.view_from_world "
    "says; the near plane of clip_from_view or the unit of view_from_world is wrong.",
    "camera.view_from_world has no translation, but the camera moves; give the whole matrix, or "
    "one that is relative to one origin for this frame and the last.",
    "at # % of the pixels depth is not what the cameras of this frame and the last expect, so that "
    "their history is rejected; give the matrices that depth was drawn with, and motion vectors if "
    "objects move.",
    "motion vectors are 0 although the camera moves; they must contain the motion by the camera.",
    "motion vectors fit the motion of the camera with the other sign of x or y; change "
    "motion_scale.",
    "motion vectors fit the motion of the camera in another unit; change motion_scale.",
    "motion vectors fit the motion of the camera with other jitter; change motion_offset.",
};

VkExtent2D read_size(const AlcoveView& view) {
  return view.info.read_area.width > 0
             ? VkExtent2D{view.info.read_area.width, view.info.read_area.height}
             : VkExtent2D{view.images[ALCOVE_IMAGE_DEPTH].width,
                          view.images[ALCOVE_IMAGE_DEPTH].height};
}

bool is_reported(Mistake mistake, std::uint32_t seen) {
  // An index may go back once, for example when a game restarts.
  return mistake == Mistake::index_goes_back ? std::popcount(seen) >= 2
                                             : std::popcount(seen & 0xffu) >= 5;
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
  if (!same(given.info.camera, view.camera)) {
    const bool is_last = same(given.info.previous_camera, view.camera);
    const bool is_this = same(given.info.previous_camera, given.info.camera);
    const bool other_projection =
        same(given.info.previous_camera.view_from_world, view.camera.view_from_world);
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
          const float unit = measure < 10.0f ? 100.0f : 1.0f;
          sentence.replace(at, 1, number_text(std::round(measure * unit) / unit));
        }
        text += "View " + std::to_string(view.id) + ": " + sentence + "\n";
      }
    }
  }
  return text;
}

}  // namespace alcove::passes
