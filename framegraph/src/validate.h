// The parts of validation, and what they collect errors with.
#pragma once

#include <string>
#include <utility>

#include "access_bits.h"
#include "workspace.h"

namespace alcove::framegraph {

struct Validation {
  const GraphDescription& graph;
  const Limits& limits;
  Workspace& workspace;
  Errors& errors;

  void fail(ErrorCode code, std::string message, std::uint32_t pass = kNone,
            std::uint32_t resource = kNone, std::uint32_t version = 0) {
    errors.push_back({code, std::move(message), VK_SUCCESS, pass, resource, version});
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

// Descriptions, imports and histories; numbers the subresources of what is right.
void validate_resources(Validation& validation);

inline bool layout_is_usable(VkImageLayout layout) {
  return layout != VK_IMAGE_LAYOUT_UNDEFINED && layout != VK_IMAGE_LAYOUT_PREINITIALIZED;
}

// What most accesses are, found out at once; anything else is for validate_access.
inline bool is_plainly_right(const Validation& v, QueueClass queue, const AccessRecord& access) {
  if ((access.flags & (kNull | kForeign | kClosed)) != 0) return false;
  const ResourceRecord& r = v.graph.resources[access.resource];
  const Range& range = access.range;
  const bool texture = r.kind == ResourceKind::texture;
  const bool in_range = range.mips != 0 && range.layers != 0 &&
                        range.base_mip + range.mips <= r.mips &&
                        range.base_layer + range.layers <= r.layers;
  const bool writes = (access.access & kWriteBits) != 0;
  return access.kind == r.kind && access.stages != 0 && access.access != 0 &&
         writes == ((access.flags & kWrite) != 0) &&
         (!texture || (in_range && layout_is_usable(access.layout))) &&
         r.origin != Origin::imported && v.limits.formats.query == nullptr &&
         queue == QueueClass::graphics;
}
// One access by itself: its handle, range, usage and masks. False when it cannot be followed.
bool validate_access(Validation& validation, std::uint32_t pass, const AccessRecord& access);

}  // namespace alcove::framegraph
