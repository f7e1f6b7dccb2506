// Creates and destroys contexts.
#include "alcove/alcove.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "c/context.h"
#include "c/context_info.h"

using namespace alcove;
using passes::guarded;
using passes::invalid;
using passes::Message;
using passes::Result;

namespace {

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
  if (!executor) return tl::unexpected(passes::first_error(executor.error()));
  auto pipelines = passes::Pipelines::create(handles, info.frames_in_flight, info.pipeline_cache);
  if (!pipelines) return tl::unexpected(passes::with_prefix("The context: ")(pipelines.error()));
  context = std::make_unique<AlcoveContext>(std::move(host), std::move(*executor),
                                            std::move(*pipelines), handles, info.frames_in_flight)
                .release();
  return {};
}

}  // namespace

uint32_t alcoveGetVersion(void) { return ALCOVE_VERSION; }

AlcoveResult alcoveCreateContext(const AlcoveContextInfo* info, AlcoveContext** context,
                                 char* message) {
  Message said{};
  const AlcoveResult result = guarded(said.data(), [&]() -> Result {
    if (context == nullptr) return invalid("There is no place for the context.");
    *context = nullptr;
    return passes::check(info).and_then([&] { return create(*info, *context); });
  });
  if (message != nullptr) std::memcpy(message, said.data(), said.size());
  if (result != ALCOVE_SUCCESS && info != nullptr && info->struct_size == sizeof *info &&
      info->log.write != nullptr)
    info->log.write(info->log.user, ALCOVE_SEVERITY_ERROR, said.data());
  return result;
}

void alcoveDestroyContext(AlcoveContext* context) { delete context; }

const char* alcoveGetMessage(const AlcoveContext* context) {
  return context == nullptr ? "There is no context." : context->message.data();
}
