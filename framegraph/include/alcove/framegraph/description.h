// A declared frame as plain data. Graph writes it; the compiler, the verifier and the printers read
// it. Its records have no padding bytes, so that the plan cache can compare two declarations byte
// by byte.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "alcove/framegraph/records.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

enum class Origin : std::uint8_t { transient, imported, history };

struct ResourceRecord {
  std::uint64_t size = 0;  // of a buffer, in bytes
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t depth = 1;
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;
  std::uint32_t samples = 1;
  VkFlags create_flags = 0;  // of a texture, TextureDesc::flags; of a buffer, BufferDesc::usage
  std::uint32_t external = kNone;  // of an import or a history slot: index into externals
  ResourceKind kind = ResourceKind::texture;
  Origin origin = Origin::transient;
  std::uint8_t slot = 0;   // of a history: its age in frames; 0 is this frame's slot
  std::uint8_t slots = 1;  // of a history: the number of its slots
  bool operator==(const ResourceRecord&) const = default;
};
static_assert(std::has_unique_object_representations_v<ResourceRecord>);

// The state of a resource that exists outside the frame: an import or a history slot.
struct ExternalRecord {
  State initial_state;
  State final_state;
  VkFlags usage = 0;
  // Index of an external that was imported earlier in this frame with the same VkBuffer, or with
  // the same VkImage and layers that overlap; kNone if there is none.
  std::uint32_t same_as = kNone;
  std::uint8_t has_contents = 0;                      // 0 or 1
  std::uint8_t has_final_state = 0;                   // 0 or 1
  std::uint8_t has_handle = 0;                        // 0 or 1: the caller gave a Vulkan handle
  HistoryValidity validity = HistoryValidity::valid;  // of a history slot
  QueueClass queue = QueueClass::graphics;            // the queue that used it last
  std::uint8_t reserved[3] = {};
  bool operator==(const ExternalRecord&) const = default;
};
static_assert(std::has_unique_object_representations_v<ExternalRecord>);

enum AccessFlags : std::uint32_t {
  kWrite = 1,
  kDiscard = 2,
  kForeign = 4,    // the handle belongs to another graph or an earlier frame
  kNull = 8,       // the handle is default-constructed
  kClosed = 16,    // declared on a pass after the next pass was added
  kWhole = 32,     // declared without a range
  kOnBuffer = 64,  // the handle is a Buffer
  // Marks an OutputRecord that reports the use of a PassBuilder after Graph::reset().
  kStaleBuilder = 1u << 16,
};

// The bits of VkAccessFlags2 that write, of Vulkan and its extensions except video.
inline constexpr VkAccessFlags2 kWriteBits =
    VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT |
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT |
    VK_ACCESS_2_COMMAND_PREPROCESS_WRITE_BIT_NV | VK_ACCESS_2_MICROMAP_WRITE_BIT_EXT |
    VK_ACCESS_2_OPTICAL_FLOW_WRITE_BIT_NV;

constexpr bool layout_is_usable(VkImageLayout layout) {
  return layout != VK_IMAGE_LAYOUT_UNDEFINED && layout != VK_IMAGE_LAYOUT_PREINITIALIZED;
}

struct AccessRecord {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkFlags usage = 0;
  std::uint32_t resource = kNone;
  std::uint32_t flags = 0;  // AccessFlags
  // The declared range, with kAll replaced by the texture's number of mips or layers. kAll remains
  // only if the base mip or layer is out of range.
  Range range;
  std::uint32_t version = 0;  // of the handle; a write returns the next version
  std::uint32_t reserved = 0;

  ResourceKind kind() const {
    return flags & kOnBuffer ? ResourceKind::buffer : ResourceKind::texture;
  }
  bool operator==(const AccessRecord&) const = default;
};
static_assert(std::has_unique_object_representations_v<AccessRecord>);

enum PassFlags : std::uint8_t { kSideEffect = 1 };

struct PassRecord {
  std::uint32_t first_access = 0;
  QueueClass queue = QueueClass::graphics;
  std::uint8_t flags = 0;
  std::uint16_t reserved = 0;
  bool operator==(const PassRecord&) const = default;
};
static_assert(std::has_unique_object_representations_v<PassRecord>);

// A version of a resource that Graph::output() has marked.
struct OutputRecord {
  std::uint32_t resource = kNone;
  std::uint32_t version = 0;
  std::uint32_t flags = 0;  // kForeign, kNull, kStaleBuilder
  bool operator==(const OutputRecord&) const = default;
};
static_assert(std::has_unique_object_representations_v<OutputRecord>);

// Names appear in messages only and are not part of the comparison of declarations. They lie in the
// memory of the graph and are valid until its reset().
struct GraphDescription {
  Records<PassRecord> passes;
  Records<AccessRecord> accesses;  // in order of passes
  Records<ResourceRecord> resources;
  Records<ExternalRecord> externals;
  Records<OutputRecord> outputs;
  // The number of the frame in which the current records (all except the pass records) were first
  // declared. Two descriptions with the same edition have the same records, because frame numbers
  // are unique among all graphs.
  std::uint64_t edition = 0;
  std::vector<std::string_view> pass_names;  // it may be longer than `passes`
  std::vector<std::string_view> resource_names;

  std::span<const AccessRecord> pass_accesses(std::uint32_t pass) const {
    const std::uint32_t first = passes[pass].first_access;
    const std::uint32_t last = pass + 1 < passes.size()
                                   ? passes[pass + 1].first_access
                                   : static_cast<std::uint32_t>(accesses.size());
    return {accesses.data() + first, last - first};
  }
  std::string_view pass_name(std::uint32_t pass) const { return pass_names[pass]; }
  std::string_view resource_name(std::uint32_t resource) const { return resource_names[resource]; }
};

// Returns whether two declarations are equal apart from their names.
bool same_declaration(const GraphDescription& a, const GraphDescription& b);
// Returns a hash of everything that same_declaration compares.
std::uint64_t hash(const GraphDescription& description);

}  // namespace alcove::framegraph
