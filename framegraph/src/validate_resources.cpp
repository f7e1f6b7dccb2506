#include <algorithm>
#include <bit>

#include "validate.h"

namespace alcove::framegraph {
namespace {

std::string size_text(const ResourceRecord& r) {
  std::string text = std::to_string(r.width) + "x" + std::to_string(r.height);
  if (r.depth > 1) text.append("x").append(std::to_string(r.depth));
  return text;
}

bool check_extent(Validation& v, std::uint32_t index, const ResourceRecord& r) {
  const auto bad = [&](const std::string& what) {
    return v.refuse(ErrorCode::bad_description, index, what);
  };
  if (r.width == 0 || r.height == 0 || r.depth == 0)
    return bad("has size " + size_text(r) + ": every side must be at least 1");
  const std::uint32_t limit = r.depth > 1 ? v.limits.max_extent_3d : v.limits.max_extent_2d;
  const std::uint32_t longest = std::max({r.width, r.height, r.depth});
  if (longest > limit)
    return bad("has size " + size_text(r) + ": the device allows at most " + std::to_string(limit) +
               " on a side");
  const auto most_mips = static_cast<std::uint32_t>(std::bit_width(longest));
  if (r.mips == 0 || r.mips > most_mips)
    return bad("has " + std::to_string(r.mips) + " mips: a " + size_text(r) + " texture has 1 to " +
               std::to_string(most_mips));
  return true;
}

bool check_texture(Validation& v, std::uint32_t index, const ResourceRecord& r) {
  const auto bad = [&](const std::string& what) {
    return v.refuse(ErrorCode::bad_description, index, what);
  };
  if (r.format == VK_FORMAT_UNDEFINED) return bad("has no format: give TextureDesc::format");
  if (!check_extent(v, index, r)) return false;
  if (r.layers == 0 || r.layers > v.limits.max_layers)
    return bad("has " + std::to_string(r.layers) + " layers: the device allows 1 to " +
               std::to_string(v.limits.max_layers));
  if ((r.create_flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) != 0 &&
      (r.width != r.height || r.layers < 6 || r.samples > 1))
    return bad("is cube compatible: it must be square and have at least 6 layers and one sample");
  if (r.depth > 1 && r.layers > 1) return bad("is 3D and an array: it can be one of the two");
  if (r.samples == 0 || (r.samples & (r.samples - 1)) != 0 || r.samples > v.limits.max_samples)
    return bad("has " + std::to_string(r.samples) + " samples: a power of two up to " +
               std::to_string(v.limits.max_samples) + " is allowed");
  if (r.samples > 1 && (r.mips > 1 || r.depth > 1))
    return bad("has several samples and several mips or slices: a multisampled texture has one");
  return true;
}

bool check_buffer(Validation& v, std::uint32_t index, const ResourceRecord& r) {
  if (r.size != 0 && r.size <= v.limits.max_buffer_size) return true;
  return v.refuse(ErrorCode::bad_description, index,
                  "has " + std::to_string(r.size) + " bytes: the device allows 1 to " +
                      std::to_string(v.limits.max_buffer_size));
}

// Returns the resource that belongs to an external.
std::uint32_t resource_of(const GraphDescription& graph, std::uint32_t external) {
  std::uint32_t index = 0;
  while (graph.resources[index].external != external) ++index;
  return index;
}

void check_external(Validation& v, std::uint32_t index, const ResourceRecord& r) {
  const ExternalRecord& external = v.graph.externals[r.external];
  if (external.same_as != kNone)
    v.refuse(ErrorCode::bad_import, index,
             "and " + v.resource_text(resource_of(v.graph, external.same_as)) +
                 " are imported with one " +
                 (r.kind == ResourceKind::texture ? "VkImage" : "VkBuffer") +
                 ": import it once and use that handle in every pass, because the graph orders "
                 "the uses of each resource by itself");
  if (!external.has_handle)
    v.refuse(ErrorCode::bad_import, index,
             std::string("is imported without a Vulkan handle: set ") +
                 (r.kind == ResourceKind::texture ? "ImportedTexture::image"
                                                  : "ImportedBuffer::buffer"));
  for (const State& state : {external.initial_state, external.final_state})
    if (r.origin == Origin::imported && !can_make(state.stages, state.access))
      v.refuse(ErrorCode::bad_import, index,
               "is imported with a state whose access none of its stages can make, or with a stage "
               "that the graph does not know: give stages that make the access");
  if (r.origin == Origin::history && r.slots < 2)
    v.refuse(ErrorCode::history_cycle, index,
             "is a history of one slot, whose last frame is this frame: give it at least 2 slots");
}

// Returns whether the resource is a valid transient texture with one subresource and without flags.
bool is_plain_texture(const ResourceRecord& r, std::uint32_t max_extent) {
  return r.kind == ResourceKind::texture && r.external == kNone && r.create_flags == 0 &&
         r.format != VK_FORMAT_UNDEFINED && r.depth == 1 && r.mips == 1 && r.layers == 1 &&
         r.samples == 1 && r.width - 1 < max_extent && r.height - 1 < max_extent;
}

// Checks any resource. Returns the number of its subresources, 0 if its description is invalid.
std::uint32_t subresources_of(Validation& v, std::uint32_t index, const ResourceRecord& r) {
  const bool texture = r.kind == ResourceKind::texture;
  const bool right = texture ? check_texture(v, index, r) : check_buffer(v, index, r);
  if (r.external != kNone) check_external(v, index, r);
  if (!right) return 0;
  return texture ? r.mips * r.layers : 1;
}

}  // namespace

void validate_resources(Validation& v) {
  const auto& resources = v.graph.resources;
  v.workspace.first_sub.resize(resources.size() + 1);
  std::uint32_t* first = v.workspace.first_sub.data();
  std::uint32_t next = 0;
  std::uint32_t index = 0;
  for (const ResourceRecord& r : resources) {
    *first++ = next;
    next += is_plain_texture(r, v.limits.max_extent_2d) ? 1 : subresources_of(v, index, r);
    ++index;
  }
  *first = next;
}

}  // namespace alcove::framegraph
