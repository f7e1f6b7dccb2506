// An error: a code, the pass and resource it concerns, and a sentence that says what to change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

enum class ErrorCode : std::uint8_t {
  stale_handle,           // a version that a later write has replaced
  foreign_handle,         // a handle of another graph, or of a frame before reset()
  null_handle,            // a default-constructed handle
  read_before_write,      // a read of contents that nothing wrote
  read_and_write,         // one pass reads and writes one subresource in two accesses
  two_writers,            // one pass writes one subresource twice
  attachment_mismatch,    // one pass's attachments differ in size or samples
  missing_usage,          // an import was not created for this use
  unsupported_format,     // the device does not support this use of the format
  bad_range,              // a range with mips or layers that the texture does not have
  bad_access,             // an access that contradicts itself or the pass's queue
  bad_description,        // a size of zero, an undefined format, or a size above a device limit
  bad_import,             // an import without a Vulkan handle, or with that of another import
  history_never_written,  // a pass reads a history that no frame writes
  history_cycle,          // a history's slots form a cycle within the frame
  closed_pass,            // an access declared after the next pass was begun
  missing_callback,       // a live pass has no recording callback
  undeclared_use,         // a recording callback used a resource that its pass did not declare
  misuse,                 // a call that is not allowed at this point
  no_queue,               // the device has no queue for the pass
  verification,           // the verifier found an error in the plan, which is a bug of the compiler
  vulkan,                 // a Vulkan call failed; see `result`
};

struct Error {
  ErrorCode code = ErrorCode::vulkan;
  std::string message;
  VkResult result = VK_SUCCESS;    // with ErrorCode::vulkan
  std::uint32_t pass = kNone;      // declaration index, or kNone if no pass is concerned
  std::uint32_t resource = kNone;  // index of its handle, or kNone if no resource is concerned
  std::uint32_t version = 0;
};

using Errors = std::vector<Error>;

// Returns a text with one line for each error.
std::string to_string(const Errors& errors);

}  // namespace alcove::framegraph
