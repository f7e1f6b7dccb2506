// Functions that report on a context's frames: memory, times, the plan, mistakes.
#include <algorithm>
#include <cstdint>
#include <string>

#include "alcove/alcove.h"
#include "alcove/framegraph/print.h"
#include "c/context.h"

using namespace alcove;
using passes::copy_text;
using passes::guarded;
using passes::invalid;
using passes::Result;

AlcoveResult alcoveGetMemory(AlcoveContext* context, AlcoveMemory* memory) {
  return guarded(context, [&]() -> Result {
    if (memory == nullptr) return invalid("There is no AlcoveMemory.");
    if (auto valid = passes::check_size(memory->struct_size, sizeof *memory, "AlcoveMemory");
        !valid)
      return valid;
    const framegraph::MemoryStatistics& sizes = context->report.memory;
    const bool recorded = context->report.plan != nullptr;
    *memory = {.struct_size = sizeof *memory,
               .transients = sizes.aliased,
               .transients_unshared = sizes.unaliased,
               .history = sizes.history,
               .allocated = recorded ? sizes.allocated + context->pipelines.memory_bytes() : 0};
    return {};
  });
}

AlcoveResult alcoveGetTimings(AlcoveContext* context, uint32_t slot, uint32_t* count,
                              AlcoveTiming* timings) {
  return guarded(context, [&]() -> Result {
    if (count == nullptr) return invalid("There is no place for the number of timings.");
    if (slot >= context->frames_in_flight)
      return invalid("Slot " + std::to_string(slot) + " is not below the " +
                     std::to_string(context->frames_in_flight) + " frames in flight.");
    const auto times = context->executor.timings(slot);
    const auto there = static_cast<std::uint32_t>(times.size());
    *count = timings == nullptr ? there : std::min(*count, there);
    for (std::uint32_t i = 0; timings != nullptr && i < *count; ++i) {
      copy_text(times[i].name, timings[i].pass, sizeof timings[i].pass);
      timings[i].view = context->passes_of_views[slot].view_of(times[i].pass);
      timings[i].milliseconds = times[i].milliseconds;
    }
    return {};
  });
}

size_t alcovePrintPlan(AlcoveContext* context, char* text, size_t size) {
  copy_text("", text, size);
  if (context == nullptr || context->report.plan == nullptr) return 0;
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
    length = copy_text(context->finder.describe(), text, size);
    return {};
  });
  return length;
}
