// The context of the C interface, and how its functions run calls that can fail.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove.h"
#include "alcove/framegraph/executor.h"
#include "alcove/passes/kernels.h"
#include "c/failure.h"
#include "c/host.h"
#include "c/images.h"
#include "c/still_views.h"
#include "diagnose/mistake_finder.h"
#include "diagnose/pixel_observer.h"

namespace alcove::passes {

using Message = std::array<char, ALCOVE_MAX_MESSAGE>;
using Result = tl::expected<void, Failure>;

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

// Copies a text like snprintf: writes at most `size` bytes, including the terminating zero. Returns
// the number of bytes of the whole text without that zero. `text` may be null if `size` is 0.
std::size_t copy_text(std::string_view from, char* text, std::size_t size);

// Stores the message of a failure. Returns the result.
AlcoveResult keep(Message& message, const Result& result);

// Runs `call`, which returns a Result, and stores its message if it failed. The library itself
// throws nothing, but operator new may: its exception becomes a failure. In a build without
// exceptions, the program ends instead.
template <typename Call>
AlcoveResult guarded(Message& message, const Call& call) {
#ifdef __cpp_exceptions
  try {
    return keep(message, call());
  } catch (const std::bad_alloc&) {
    copy_text("The host is out of memory.", message.data(), message.size());
    return ALCOVE_ERROR_OUT_OF_HOST_MEMORY;
  } catch (...) {
    copy_text("The library failed for a reason that it does not know.", message.data(),
              message.size());
    return ALCOVE_ERROR_INTERNAL;
  }
#else
  return keep(message, call());
#endif
}

}  // namespace alcove::passes

struct AlcoveContext {
  AlcoveContext(std::unique_ptr<alcove::passes::HostAdapter> made_host,
                alcove::framegraph::Executor made_executor, alcove::passes::Kernels made_kernels,
                const alcove::framegraph::DeviceHandles& device, std::uint32_t slots)
      : host(std::move(made_host)),
        frames_in_flight(slots),
        executor(std::move(made_executor)),
        kernels(std::move(made_kernels)),
        pixels(device, executor.functions()) {}

  std::unique_ptr<alcove::passes::HostAdapter> host;  // destroyed last
  std::uint32_t frames_in_flight;
  alcove::framegraph::Executor executor;
  alcove::passes::Kernels kernels;
  alcove::framegraph::Graph graph;
  alcove::passes::ImageTable images;
  alcove::passes::StillViews still_views;
  alcove::passes::MistakeFinder finder;
  alcove::passes::PixelObserver pixels;
  alcove::framegraph::FrameReport
      report;                // of the last recorded frame; its plan is null before the first
  std::uint32_t slot = 0;    // of the last recorded frame
  bool may_discard = false;  // the last alcoveRecordFrame has succeeded
  // The views of the frame that was last recorded with each slot.
  std::array<alcove::passes::ViewPasses, ALCOVE_MAX_FRAMES_IN_FLIGHT> passes_of_views{};
  alcove::passes::Message message{};
};

namespace alcove::passes {

// Runs a call on a context. The context stores the message of a failure, and the engine's log gets
// it too.
template <typename Call>
AlcoveResult guarded(AlcoveContext* context, const Call& call) {
  if (context == nullptr) return ALCOVE_ERROR_INVALID_INPUT;
  const AlcoveResult result = guarded(context->message, call);
  if (result != ALCOVE_SUCCESS) context->host->log(ALCOVE_SEVERITY_ERROR, context->message.data());
  return result;
}

}  // namespace alcove::passes
