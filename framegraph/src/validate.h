// The functions of validation and the state that they share.
#pragma once

#include <string>
#include <utility>

#include "workspace.h"

namespace alcove::framegraph {

struct Validation {
  const GraphDescription& graph;
  const Limits& limits;
  Workspace& workspace;
  Plan& plan;
  Errors& errors;

  void fail(ErrorCode code, std::string message, std::uint32_t pass = kNone,
            std::uint32_t resource = kNone, std::uint32_t version = 0) {
    errors.push_back({code, std::move(message), VK_SUCCESS, pass, resource, version});
  }
  // Adds an error with the sentence "pass 'NAME' WHAT" about one of its accesses.
  void fail(ErrorCode code, std::uint32_t pass, const AccessRecord& access,
            const std::string& what) {
    fail(code, pass_text(pass) + " " + what, pass, access.resource, access.version);
  }
  // Adds an error with the sentence "texture 'NAME' WHAT", or of a buffer. Returns false.
  bool refuse(ErrorCode code, std::uint32_t resource, const std::string& what) {
    fail(code, resource_text(resource) + " " + what, kNone, resource);
    return false;
  }
  std::string pass_text(std::uint32_t pass) const {
    return std::string("pass '").append(graph.pass_name(pass)).append("'");
  }
  std::string resource_text(std::uint32_t resource) const {
    const bool texture = graph.resources[resource].kind == ResourceKind::texture;
    return std::string(texture ? "texture '" : "buffer '")
        .append(graph.resource_name(resource))
        .append("'");
  }
};

// Checks descriptions, imports and histories, and numbers the subresources of valid resources.
void validate_resources(Validation& validation);

// Returns whether the graph knows all of these stages, and whether one of them can make each access
// ("Supported access types" of the specification).
bool can_make(VkPipelineStageFlags2 stages, VkAccessFlags2 access);

// Returns the pipeline stages that a queue class does not support.
VkPipelineStageFlags2 forbidden_stages(QueueClass queue);

// Checks the handle, range, usage and masks of one access. Returns false if the access names no
// valid resource.
bool validate_access(Validation& validation, std::uint32_t pass, const AccessRecord& access);

}  // namespace alcove::framegraph
