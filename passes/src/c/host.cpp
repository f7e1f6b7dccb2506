#include "c/host.h"

#include <string>

namespace alcove::passes {

Result check_memory(const AlcoveContextInfo& info) {
  const AlcoveMemoryFunctions& memory = info.memory_functions;
  if ((memory.allocate == nullptr) != (memory.free == nullptr)) {
    return invalid(
        "AlcoveContextInfo::memory_functions has only one of allocate and free; give both.");
  }
  return {};
}

HostAdapter::HostAdapter(const AlcoveContextInfo& info)
    : callbacks_(info.allocation_callbacks), memory_(info.memory_functions), log_(info.log) {}

framegraph::HostServices HostAdapter::services() {
  framegraph::HostServices services;
  services.allocation_callbacks = callbacks_;
  if (memory_.allocate != nullptr) services.memory = {&allocate, &free, this};
  if (log_.write != nullptr) services.log = {&write, this};
  return services;
}

void HostAdapter::log(AlcoveSeverity severity, const char* sentence) const {
  if (log_.write != nullptr) log_.write(log_.user, severity, sentence);
}

VkResult HostAdapter::allocate(void* user, const framegraph::MemoryRequest& request,
                               framegraph::MemoryRange& range) {
  const AlcoveMemoryFunctions& memory = static_cast<HostAdapter*>(user)->memory_;
  const AlcoveMemoryRequest engine_request{request.requirements, request.required,
                                           request.preferred,
                                           static_cast<AlcoveMemoryLifetime>(request.lifetime)};
  AlcoveMemoryRange engine_range{};
  const VkResult result = memory.allocate(memory.user, &engine_request, &engine_range);
  range = {engine_range.memory, engine_range.offset, engine_range.mapped, engine_range.handle};
  return result;
}

void HostAdapter::free(void* user, const framegraph::MemoryRange& range) {
  const AlcoveMemoryFunctions& memory = static_cast<HostAdapter*>(user)->memory_;
  const AlcoveMemoryRange engine_range{range.memory, range.offset, range.mapped, range.handle};
  memory.free(memory.user, &engine_range);
}

void HostAdapter::write(void* user, framegraph::Severity severity, const char* sentence) {
  static_cast<HostAdapter*>(user)->log(static_cast<AlcoveSeverity>(severity), sentence);
}

}  // namespace alcove::passes
