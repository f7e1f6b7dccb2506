// The context of the C interface, and how its functions run calls on it that can fail.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "alcove/alcove.h"
#include "alcove/framegraph/executor.h"
#include "alcove/passes/pipelines.h"
#include "c/failure.h"
#include "c/host.h"
#include "c/view.h"
#include "diagnose/mistake_finder.h"
#include "diagnose/pixel_observer.h"

namespace alcove::passes {

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

}  // namespace alcove::passes

struct AlcoveContext {
  AlcoveContext(std::unique_ptr<alcove::passes::HostAdapter> made_host,
                alcove::framegraph::Executor made_executor,
                alcove::passes::Pipelines made_pipelines,
                const alcove::framegraph::DeviceHandles& device, std::uint32_t slots)
      : host(std::move(made_host)),
        frames_in_flight(slots),
        executor(std::move(made_executor)),
        pipelines(std::move(made_pipelines)),
        pixels(device, executor.functions()) {}

  std::unique_ptr<alcove::passes::HostAdapter> host;  // destroyed last
  std::uint32_t frames_in_flight;
  alcove::framegraph::Executor executor;
  alcove::passes::Pipelines pipelines;
  alcove::framegraph::Graph graph;
  alcove::passes::ImageTable images;
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
  Message said{};
  const AlcoveResult result = guarded(said.data(), call);
  if (result == ALCOVE_SUCCESS) return result;
  context->message = said;
  context->host->log(ALCOVE_SEVERITY_ERROR, said.data());
  return result;
}

}  // namespace alcove::passes
