// Passes the engine's allocators and log, which the C interface takes, to the C++ libraries.
#pragma once

#include "alcove/alcove.h"
#include "alcove/framegraph/host_services.h"
#include "c/failure.h"

namespace alcove::passes {

// Returns an error if only one of the memory functions is given.
[[nodiscard]] Result check_memory(const AlcoveContextInfo& info);

// Calls the engine's allocators and log from the hooks of the C++ libraries. The object must not
// move and must outlive every user of services().
class HostAdapter {
 public:
  explicit HostAdapter(const AlcoveContextInfo& info);
  HostAdapter(const HostAdapter&) = delete;
  HostAdapter& operator=(const HostAdapter&) = delete;

  framegraph::HostServices services();
  // Passes a sentence to the engine's log, if there is one.
  void log(AlcoveSeverity severity, const char* sentence) const;

 private:
  static VkResult allocate(void* user, const framegraph::MemoryRequest& request,
                           framegraph::MemoryRange& range);
  static void free(void* user, const framegraph::MemoryRange& range);
  static void write(void* user, framegraph::Severity severity, const char* sentence);

  const VkAllocationCallbacks* callbacks_;
  AlcoveMemoryFunctions memory_;
  AlcoveLog log_;
};

}  // namespace alcove::passes
