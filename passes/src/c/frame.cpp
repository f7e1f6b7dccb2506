// Prepares, records and discards frames, and drops what a context keeps of views and images.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "alcove/alcove.h"
#include "alcove/framegraph/compile.h"
#include "c/context.h"
#include "c/view.h"

using namespace alcove;
using passes::guarded;
using passes::invalid;
using passes::Result;
using passes::ViewPasses;

namespace {

// The most dispatches of a view.
constexpr std::uint32_t kPassesOfAView = 8;
static_assert(ALCOVE_MAX_FRAMES_IN_FLIGHT == passes::Pipelines::kMaxFramesInFlight);
static_assert(ALCOVE_MAX_VIEWS * kPassesOfAView + 1 <= passes::Pipelines::kMaxDispatches,
              "and one that samples pixels");

Result check(const AlcoveContext& context, const AlcoveFrame* frame) {
  if (frame == nullptr) return invalid("There is no AlcoveFrame.");
  if (auto valid = passes::check_size(frame->struct_size, sizeof *frame, "AlcoveFrame"); !valid)
    return valid;
  if (frame->slot >= context.frames_in_flight) {
    return invalid("AlcoveFrame::slot is " + std::to_string(frame->slot) +
                   "; it must be below the " + std::to_string(context.frames_in_flight) +
                   " frames in flight.");
  }
  if (frame->view_count < 1 || frame->view_count > ALCOVE_MAX_VIEWS || frame->views == nullptr) {
    return invalid("The frame has " +
                   std::to_string(frame->views == nullptr ? 0 : frame->view_count) +
                   " views; it must have 1 to " + std::to_string(ALCOVE_MAX_VIEWS) + ".");
  }
  for (std::uint32_t i = 0; i < frame->view_count; ++i) {
    const AlcoveView& view = frame->views[i];
    if (auto valid = passes::check_size(view.struct_size, sizeof view, "AlcoveView"); !valid)
      return valid;
    for (std::uint32_t before = 0; before < i; ++before) {
      if (frame->views[before].info.id == view.info.id) {
        return invalid("Two views of the frame have the id " + std::to_string(view.info.id) +
                       "; give each its own.");
      }
    }
  }
  return {};
}

// Removes the histories that the views of the last recorded frame no longer use because their
// settings or outputs changed. It is called when that frame can no longer be discarded.
void confirm_last_frame(AlcoveContext& context) {
  if (!context.may_discard) return;
  context.may_discard = false;
  const ViewPasses& passes = context.passes_of_views[context.slot];
  for (std::uint32_t i = 0; i < passes.count; ++i)
    passes::drop_view(context.graph, passes.views[i].id);
}

// The declaration of a frame. Its changes of histories are undone if it is not recorded.
struct Declaration {
  explicit Declaration(framegraph::Graph& of) : graph(of) { graph.reset(); }
  ~Declaration() {
    if (!recorded) graph.histories().undo();
  }
  Declaration(const Declaration&) = delete;
  Declaration& operator=(const Declaration&) = delete;

  framegraph::Graph& graph;
  bool recorded = false;
};

tl::expected<ViewPasses, passes::Error> add_views(framegraph::Graph& graph, AlcoveContext& context,
                                                  const AlcoveFrame& frame, bool prepare) {
  ViewPasses passes;
  context.images.reset();
  for (const AlcoveView& view : std::span(frame.views, frame.view_count)) {
    const bool inspects = frame.diagnose_pixels != VK_FALSE && passes.count == 0;
    auto added = passes::add_view(graph, context.pipelines, context.images, view, frame, prepare,
                                  inspects ? &context.pixels : nullptr);
    if (!added) return tl::unexpected(std::move(added.error()));
    passes.views[passes.count++] = {view.info.id,
                                    static_cast<std::uint32_t>(graph.description().passes.size())};
  }
  return passes;
}

// Creates the pipelines for the frame by declaring it in a separate graph. The context's own graph,
// its histories and its last recorded frame stay as they are.
Result prepare(AlcoveContext& context, const AlcoveFrame* frame) {
  if (auto valid = check(context, frame); !valid) return valid;
  framegraph::Graph graph;
  if (auto passes = add_views(graph, context, *frame, true); !passes)
    return tl::unexpected(std::move(passes.error()));
  // Compiles for the errors alone, such as an image that the device cannot use in this way.
  if (const auto plan = framegraph::compile(graph, context.executor.limits()); !plan)
    return tl::unexpected(passes::first_error(plan.error()));
  return {};
}

Result record(AlcoveContext& context, VkCommandBuffer commands, const AlcoveFrame* frame) {
  confirm_last_frame(context);
  context.report = {};
  if (commands == VK_NULL_HANDLE) return invalid("There is no command buffer to record into.");
  if (auto valid = check(context, frame); !valid) return valid;
  Declaration declaration(context.graph);
  context.pipelines.begin_frame(frame->slot);
  context.pixels.collect(frame->slot, context.finder);
  const std::size_t pipelines = context.pipelines.pipeline_count();
  const auto passes = add_views(context.graph, context, *frame, false);
  if (!passes) return tl::unexpected(passes.error());
  if (context.pipelines.pipeline_count() != pipelines) {
    context.host->log(
        ALCOVE_SEVERITY_WARNING,
        "Pipelines were created while a frame was recorded, which may take the driver "
        "a second; call alcovePrepareFrame while loading.");
  }
  const auto report = context.executor.record(context.graph, commands, {frame->slot});
  if (!report) return tl::unexpected(passes::first_error(report.error()));
  context.report = *report;
  context.slot = frame->slot;
  context.may_discard = declaration.recorded = true;
  context.passes_of_views[frame->slot] = *passes;
  if (context.finder.observe(*frame))
    context.host->log(ALCOVE_SEVERITY_WARNING, passes::MistakeFinder::kTooManyViews);
  context.pixels.recorded(frame->slot);
  return {};
}

}  // namespace

AlcoveResult alcovePrepareFrame(AlcoveContext* context, const AlcoveFrame* frame) {
  return guarded(context, [&] { return prepare(*context, frame); });
}

AlcoveResult alcoveRecordFrame(AlcoveContext* context, VkCommandBuffer commands,
                               const AlcoveFrame* frame) {
  return guarded(context, [&] { return record(*context, commands, frame); });
}

AlcoveResult alcoveDiscardFrame(AlcoveContext* context) {
  return guarded(context, [&]() -> Result {
    if (context->may_discard) {
      context->executor.discard(context->graph, {context->slot});
      context->pixels.discarded(context->slot);
      context->report = {};
    }
    context->may_discard = false;
    return {};
  });
}

AlcoveResult alcoveDropView(AlcoveContext* context, uint32_t id) {
  return guarded(context, [&]() -> Result {
    // The last frame declared the history, so that frame must be ended before the history is
    // dropped. Its plan can still be printed.
    confirm_last_frame(*context);
    context->graph.histories().end_frame();
    passes::drop_view(context->graph, id);
    context->finder.drop_view(id);
    return {};
  });
}

AlcoveResult alcoveForgetImage(AlcoveContext* context, VkImage image) {
  return guarded(context, [&]() -> Result {
    context->executor.forget(image);
    return {};
  });
}

AlcoveResult alcoveSetStillFrame(uint32_t number, AlcoveView* view) {
  if (view == nullptr || view->struct_size != sizeof *view) return ALCOVE_ERROR_INVALID_INPUT;
  AlcoveViewInfo& info = view->info;
  info.reset_history = number == 0 ? 1 : 0;
  info.static_frames = number;
  info.previous_camera = info.camera;
  const AlcoveImage& depth = view->images[ALCOVE_IMAGE_DEPTH];
  const bool whole = info.read_area.width == 0;
  info.previous_width = whole ? depth.width : info.read_area.width;
  info.previous_height = whole ? depth.height : info.read_area.height;
  return ALCOVE_SUCCESS;
}
