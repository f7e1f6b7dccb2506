#include "c/still_views.h"

#include <algorithm>
#include <limits>

#include "c/context.h"
#include "c/settings.h"

namespace alcove::passes {
namespace {

// The outputs of a view.
std::array<const AlcoveImage*, 4> outputs(const AlcoveView& view) {
  return {&view.visibility, &view.bent_normal, &view.specular, &view.multi_bounce};
}

}  // namespace

StillViews::Description StillViews::describe(const AlcoveView& view) {
  Description result;
  if (const auto settings = to_settings(view.settings)) result.settings = *settings;
  auto number = std::copy_n(view.camera.clip_from_view, 16, result.numbers.begin());
  number = std::copy_n(view.camera.view_from_world, 16, number);
  std::copy_n(view.motion_offset, 2, std::copy_n(view.motion_scale, 2, number));
  result.choices = {view.normals_in_view_space,
                    number_of(view.normal_encoding),
                    view.normals_forward_z,
                    view.largest_width,
                    view.largest_height,
                    number_of(view.depth_format),
                    view.half_size_outputs,
                    number_of(view.visibility_channel),
                    view.read_area.x,
                    view.read_area.y,
                    view.read_area.width,
                    view.read_area.height,
                    view.written_area.x,
                    view.written_area.y,
                    view.written_area.width,
                    view.written_area.height,
                    view.output_x,
                    view.output_y,
                    view.not_receiving,
                    view.not_occluding};
  const std::array<const AlcoveImage*, kImages> images{
      &view.depth,      &view.normals,      &view.motion,   &view.roughness,
      &view.back_depth, &view.second_depth, &view.albedo,   &view.mask,
      &view.visibility, &view.bent_normal,  &view.specular, &view.multi_bounce};
  std::ranges::transform(images, result.images.begin(), [](const AlcoveImage* image) {
    return Image{image->image,
                 image->view,
                 image->format,
                 {image->width, image->height, image->layer, image->samples}};
  });
  return result;
}

const StillViews::View* StillViews::find(std::uint32_t id) const {
  const auto found = std::ranges::find_if(
      views_, [&](const View& view) { return view.frames > 0 && view.id == id; });
  return found == views_.end() ? nullptr : &*found;
}

bool StillViews::is_converged(const AlcoveView& view) const {
  const View* const known = find(view.id);
  const bool continues =
      view.skip_converged != VK_FALSE && view.static_frames > 0 && view.reset_history == VK_FALSE;
  if (known == nullptr || !continues) return false;
  const bool has_results = std::ranges::none_of(outputs(view), [](const AlcoveImage* output) {
    return output->image != VK_NULL_HANDLE &&
           output->initial_state.layout == VK_IMAGE_LAYOUT_UNDEFINED;
  });
  const std::uint32_t needed = converged_frames(known->description.settings);
  return has_results && needed > 0 && known->frames >= needed &&
         known->description == describe(view);
}

void StillViews::observe(const AlcoveView& view, bool skipped) {
  if (view.skip_converged == VK_FALSE) {
    drop(view.id);
    return;
  }
  for (View& other : views_) ++other.age;
  const View* known = find(view.id);
  if (known == nullptr) {
    known = &*std::ranges::max_element(views_, {}, [](const View& place) {
      return place.frames == 0 ? std::numeric_limits<std::uint32_t>::max() : place.age;
    });
  }
  View& place = views_[static_cast<std::size_t>(known - views_.data())];
  place.age = 0;
  place.skipped = skipped;
  if (skipped) return;
  const Description description = describe(view);
  const bool continues = place.frames > 0 && place.id == view.id && view.static_frames > 0 &&
                         view.reset_history == VK_FALSE && place.description == description;
  place.id = view.id;
  place.frames = continues ? std::min(place.frames + 1, 0x7fffffffu) : 1;
  place.description = description;
}

void StillViews::drop(std::uint32_t id) {
  if (const View* const known = find(id))
    views_[static_cast<std::size_t>(known - views_.data())].frames = 0;
}

AlcoveViewState StillViews::state(std::uint32_t id) const {
  AlcoveViewState result{.struct_size = sizeof(AlcoveViewState)};
  if (const View* const known = find(id)) {
    result.frames = known->frames;
    result.converged_frames = converged_frames(known->description.settings);
    result.skipped = known->skipped ? VK_TRUE : VK_FALSE;
  }
  return result;
}

}  // namespace alcove::passes

using namespace alcove::passes;

uint32_t alcoveGetConvergedFrames(const AlcoveSettings* settings) {
  std::uint32_t frames = 0;
  guarded([&]() -> Result {
    return to_settings(settings).map(
        [&](const OcclusionSettings& known) { frames = converged_frames(known); });
  });
  return frames;
}

AlcoveResult alcoveSetStillFrame(uint32_t number, AlcoveView* view) {
  if (view == nullptr || view->struct_size != sizeof *view) return ALCOVE_ERROR_INVALID_INPUT;
  view->reset_history = number == 0 ? VK_TRUE : VK_FALSE;
  view->static_frames = number;
  view->previous_camera = view->camera;
  const bool whole = view->read_area.width == 0;
  view->previous_width = whole ? view->depth.width : view->read_area.width;
  view->previous_height = whole ? view->depth.height : view->read_area.height;
  return ALCOVE_SUCCESS;
}

AlcoveResult alcoveGetViewState(AlcoveContext* context, uint32_t id, AlcoveViewState* state) {
  return guarded(context, [&]() -> Result {
    if (state == nullptr) return invalid("There is no AlcoveViewState.");
    if (auto right = check_size(state->struct_size, sizeof *state, "AlcoveViewState"); !right)
      return right;
    *state = context->still_views.state(id);
    return {};
  });
}
