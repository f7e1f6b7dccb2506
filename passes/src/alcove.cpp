#include "alcove/alcove.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/print.h"
#include "alcove/passes/kernels.h"
#include "alcove/passes/reconstruct.h"
#include "c_context_info.h"
#include "c_diagnose.h"
#include "c_failure.h"
#include "c_host.h"
#include "c_images.h"
#include "c_inspect.h"
#include "c_view.h"

using namespace alcove;
using passes::Failure;
using passes::invalid;

namespace {

using Message = std::array<char, ALCOVE_MAX_MESSAGE>;
using Result = tl::expected<void, Failure>;

void write(Message& message, std::string_view text) {
  const std::size_t length = std::min(text.size(), message.size() - 1);
  std::copy_n(text.data(), length, message.data());
  message[length] = '\0';
}

// The passes of a view need no more dispatches than their share of a frame.
constexpr std::uint32_t kPassesOfAView = 9;
static_assert(ALCOVE_MAX_FRAMES_IN_FLIGHT == passes::Kernels::kMaxFramesInFlight);
static_assert(ALCOVE_MAX_VIEWS * kPassesOfAView + 1 <= passes::Kernels::kMaxDispatches,
              "and one that samples pixels");

// The views of a frame, by the number of the first pass that comes after each.
struct ViewPasses {
  struct View {
    std::uint32_t id = 0;
    std::uint32_t end = 0;
  };
  std::array<View, ALCOVE_MAX_VIEWS> views{};
  std::uint32_t count = 0;

  std::uint32_t view_of(std::uint32_t pass) const {
    return std::ranges::find_if(views, [pass](const View& view) { return pass < view.end; })->id;
  }
};

}  // namespace

struct AlcoveContext {
  AlcoveContext(std::unique_ptr<passes::HostAdapter> made_host, framegraph::Executor made_executor,
                passes::Kernels made_kernels, const framegraph::DeviceHandles& device,
                std::uint32_t slots)
      : host(std::move(made_host)),
        frames_in_flight(slots),
        executor(std::move(made_executor)),
        kernels(std::move(made_kernels)),
        pixels(device, executor.functions()) {}

  std::unique_ptr<passes::HostAdapter> host;  // destroyed last
  std::uint32_t frames_in_flight;
  framegraph::Executor executor;
  passes::Kernels kernels;
  framegraph::Graph graph;
  passes::ImageTable images;
  passes::CallObserver observer;
  passes::PixelObserver pixels;
  framegraph::FrameReport report;  // of the frame recorded last; its plan null before there is one
  std::uint32_t slot = 0;          // of that frame
  bool may_discard = false;        // it was recorded by the last alcoveRecordFrame
  // Of each slot's frame.
  std::array<ViewPasses, ALCOVE_MAX_FRAMES_IN_FLIGHT> passes_of_views{};
  Message message{};
};

namespace {

AlcoveResult keep(Message& message, const Result& result) {
  if (result) {
    return ALCOVE_SUCCESS;
  }
  write(message, result.error().message);
  return result.error().result;
}

// Runs `call`, which gives a Result, and keeps its message where it failed. Nothing of ours throws,
// but operator new may: built without exceptions, the program then ends there.
template <typename Call>
AlcoveResult guarded(Message& message, const Call& call) {
#ifdef __cpp_exceptions
  try {
    return keep(message, call());
  } catch (const std::bad_alloc&) {
    write(message, "The host is out of memory.");
    return ALCOVE_ERROR_OUT_OF_HOST_MEMORY;
  } catch (...) {
    write(message, "The library failed for a reason that it does not know.");
    return ALCOVE_ERROR_INTERNAL;
  }
#else
  return keep(message, call());
#endif
}

// Runs a call on a context, which keeps the message. The engine's log gets it too.
template <typename Call>
AlcoveResult guarded(AlcoveContext* context, const Call& call) {
  if (context == nullptr) {
    return ALCOVE_ERROR_INVALID_INPUT;
  }
  const AlcoveResult result = guarded(context->message, call);
  if (result != ALCOVE_SUCCESS) {
    context->host->log(ALCOVE_SEVERITY_ERROR, context->message.data());
  }
  return result;
}

Result create(const AlcoveContextInfo& info, AlcoveContext*& context) {
  framegraph::DeviceHandles handles;
  handles.instance = info.instance;
  handles.physical_device = info.physical_device;
  handles.device = info.device;
  handles.get_instance_proc_addr = info.get_instance_proc_addr;
  handles.queues[0].family = info.queue_family;
  handles.debug_utils = info.debug_utils != VK_FALSE;
  auto host = std::make_unique<passes::HostAdapter>(info);
  handles.host = host->services();
  framegraph::ExecutorOptions options;
  options.frames_in_flight = info.frames_in_flight;
  options.timestamps = info.timestamps != VK_FALSE;
  auto executor = framegraph::Executor::create(handles, options);
  if (!executor) {
    return tl::unexpected(passes::failure_of(executor.error()));
  }
  auto kernels = passes::Kernels::create(handles, info.frames_in_flight, info.pipeline_cache);
  if (!kernels) {
    return tl::unexpected(passes::failure_of(kernels.error(), "The context"));
  }
  context = std::make_unique<AlcoveContext>(std::move(host), std::move(*executor),
                                            std::move(*kernels), handles, info.frames_in_flight)
                .release();
  return {};
}

Result check(const AlcoveContext& context, const AlcoveFrame* frame) {
  if (frame == nullptr) {
    return invalid("There is no AlcoveFrame.");
  }
  if (auto right = passes::check_size(frame->struct_size, sizeof *frame, "AlcoveFrame"); !right) {
    return right;
  }
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
    if (auto right = passes::check_size(view.struct_size, sizeof view, "AlcoveView"); !right) {
      return right;
    }
    for (std::uint32_t before = 0; before < i; ++before) {
      if (frame->views[before].id == view.id) {
        return invalid("Two views of the frame have the id " + std::to_string(view.id) +
                       "; give each its own.");
      }
    }
  }
  return {};
}

// The frame recorded last runs: what its views do not remember any more, because their settings or
// outputs changed, goes.
void settle(AlcoveContext& context) {
  if (!context.may_discard) {
    return;
  }
  context.may_discard = false;
  const ViewPasses& passes = context.passes_of_views[context.slot];
  for (std::uint32_t i = 0; i < passes.count; ++i) {
    passes::drop_reconstruct_history(context.graph, passes::ViewName(passes.views[i].id));
  }
}

// A declaration that leaves no trace in histories where it is not recorded.
struct Declaration {
  explicit Declaration(framegraph::Graph& of) : graph(of) { graph.reset(); }
  ~Declaration() {
    if (!recorded) {
      graph.histories().undo();
    }
  }
  Declaration(const Declaration&) = delete;
  Declaration& operator=(const Declaration&) = delete;

  framegraph::Graph& graph;
  bool recorded = false;
};

tl::expected<ViewPasses, Failure> add_views(framegraph::Graph& graph, AlcoveContext& context,
                                            const AlcoveFrame& frame, bool prepare) {
  ViewPasses passes;
  context.images.reset();
  for (const AlcoveView& view : std::span(frame.views, frame.view_count)) {
    const bool inspects = frame.diagnose_pixels != VK_FALSE && passes.count == 0;
    if (auto added = passes::add_view(graph, context.kernels, context.images, view, frame, prepare,
                                      inspects ? &context.pixels : nullptr);
        !added) {
      return tl::unexpected(std::move(added.error()));
    }
    passes.views[passes.count++] = {view.id,
                                    static_cast<std::uint32_t>(graph.description().passes.size())};
  }
  return passes;
}

// In a graph of its own: the context's keeps its histories and what was recorded last.
Result prepare(AlcoveContext& context, const AlcoveFrame* frame) {
  if (auto right = check(context, frame); !right) {
    return right;
  }
  framegraph::Graph graph;
  if (auto passes = add_views(graph, context, *frame, true); !passes) {
    return tl::unexpected(std::move(passes.error()));
  }
  // For its errors: of images that the device cannot use so.
  if (const auto plan = framegraph::compile(graph, context.executor.limits()); !plan) {
    return tl::unexpected(passes::failure_of(plan.error()));
  }
  return {};
}

Result record(AlcoveContext& context, VkCommandBuffer commands, const AlcoveFrame* frame) {
  settle(context);
  context.report = {};
  if (commands == VK_NULL_HANDLE) {
    return invalid("There is no command buffer to record into.");
  }
  if (auto right = check(context, frame); !right) {
    return right;
  }
  Declaration declaration(context.graph);
  context.kernels.begin_frame(frame->slot);
  context.pixels.collect(frame->slot);
  const std::size_t pipelines = context.kernels.pipeline_count();
  const auto passes = add_views(context.graph, context, *frame, false);
  if (!passes) {
    return tl::unexpected(passes.error());
  }
  if (context.kernels.pipeline_count() != pipelines) {
    context.host->log(
        ALCOVE_SEVERITY_WARNING,
        "Pipelines were created while a frame was recorded, which may take the driver "
        "a second; call alcovePrepareFrame while loading.");
  }
  const auto report = context.executor.record(context.graph, commands, {frame->slot});
  if (!report) {
    return tl::unexpected(passes::failure_of(report.error()));
  }
  context.report = *report;
  context.slot = frame->slot;
  context.may_discard = declaration.recorded = true;
  context.passes_of_views[frame->slot] = *passes;
  context.observer.observe(*frame);
  context.pixels.recorded(frame->slot);
  return {};
}

// As snprintf does: at most `size` bytes, the closing zero among them; what all would take.
std::size_t copy_text(std::string_view from, char* text, std::size_t size) {
  if (text != nullptr && size > 0) {
    const std::size_t length = std::min(from.size(), size - 1);
    std::copy_n(from.data(), length, text);
    text[length] = '\0';
  }
  return from.size();
}

}  // namespace

uint32_t alcoveGetVersion(void) { return ALCOVE_VERSION; }

AlcoveResult alcoveCreateContext(const AlcoveContextInfo* info, AlcoveContext** context,
                                 char* message) {
  Message said{};
  const AlcoveResult result = guarded(said, [&]() -> Result {
    if (context == nullptr) {
      return invalid("There is no place for the context.");
    }
    *context = nullptr;
    return passes::check(info).and_then([&] { return create(*info, *context); });
  });
  if (message != nullptr) {
    std::memcpy(message, said.data(), said.size());
  }
  if (result != ALCOVE_SUCCESS && info != nullptr && info->struct_size == sizeof *info &&
      info->log.write != nullptr) {
    info->log.write(info->log.user, ALCOVE_SEVERITY_ERROR, said.data());
  }
  return result;
}

void alcoveDestroyContext(AlcoveContext* context) { delete context; }

const char* alcoveGetMessage(const AlcoveContext* context) {
  return context == nullptr ? "There is no context." : context->message.data();
}

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

AlcoveResult alcoveGetMemory(AlcoveContext* context, AlcoveMemory* memory) {
  return guarded(context, [&]() -> Result {
    if (memory == nullptr) {
      return invalid("There is no AlcoveMemory.");
    }
    if (auto right = passes::check_size(memory->struct_size, sizeof *memory, "AlcoveMemory");
        !right) {
      return right;
    }
    const framegraph::MemoryStatistics& found = context->report.memory;
    const bool recorded = context->report.plan != nullptr;
    *memory = {.struct_size = sizeof *memory,
               .transients = found.aliased,
               .transients_unshared = found.unaliased,
               .history = found.history,
               .allocated = recorded ? found.allocated + context->kernels.memory_bytes() : 0};
    return {};
  });
}

AlcoveResult alcoveGetTimings(AlcoveContext* context, uint32_t slot, uint32_t* count,
                              AlcoveTiming* timings) {
  return guarded(context, [&]() -> Result {
    if (count == nullptr) {
      return invalid("There is no place for the number of timings.");
    }
    if (slot >= context->frames_in_flight) {
      return invalid("Slot " + std::to_string(slot) + " is not below the " +
                     std::to_string(context->frames_in_flight) + " frames in flight.");
    }
    const auto found = context->executor.timings(slot);
    const auto there = static_cast<std::uint32_t>(found.size());
    *count = timings == nullptr ? there : std::min(*count, there);
    for (std::uint32_t i = 0; timings != nullptr && i < *count; ++i) {
      copy_text(found[i].name, timings[i].pass, sizeof timings[i].pass);
      timings[i].view = context->passes_of_views[slot].view_of(found[i].pass);
      timings[i].milliseconds = found[i].milliseconds;
    }
    return {};
  });
}

size_t alcovePrintPlan(AlcoveContext* context, char* text, size_t size) {
  copy_text("", text, size);
  if (context == nullptr || context->report.plan == nullptr) {
    return 0;
  }
  std::size_t length = 0;
  guarded(context, [&]() -> Result {
    length = copy_text(framegraph::print_text(context->graph.description(), *context->report.plan),
                       text, size);
    return {};
  });
  return length;
}

size_t alcoveDiagnose(AlcoveContext* context, char* text, size_t size) {
  copy_text("", text, size);
  std::size_t length = 0;
  guarded(context, [&]() -> Result {
    length = copy_text(context->observer.describe() + context->pixels.describe(), text, size);
    return {};
  });
  return length;
}

AlcoveResult alcoveDropView(AlcoveContext* context, uint32_t id) {
  return guarded(context, [&]() -> Result {
    // The frame that declared it is over; its plan can still be printed.
    settle(*context);
    context->graph.histories().end_frame();
    passes::drop_reconstruct_history(context->graph, passes::ViewName(id));
    return {};
  });
}

AlcoveResult alcoveForgetImage(AlcoveContext* context, VkImage image) {
  return guarded(context, [&]() -> Result {
    context->executor.forget(image);
    return {};
  });
}
