// A declared frame as plain data: what Graph writes, and what compile, verify and print read.
// The records have no padding: equal bytes mean equal declarations, which is the plan cache's key.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "alcove/framegraph/records.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

enum class ResourceKind : std::uint8_t { texture, buffer };
enum class Origin : std::uint8_t { transient, imported, history };

struct ResourceRecord {
  std::uint64_t size = 0;  // bytes, of a buffer
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t depth = 1;
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;
  std::uint32_t samples = 1;
  std::uint32_t external = kNone;  // index into externals, of an import or a history slot
  ResourceKind kind = ResourceKind::texture;
  Origin origin = Origin::transient;
  std::uint8_t slot = 0;     // of a history: 0 is this frame's, k is that of k frames ago
  std::uint8_t slots = 1;    // of a history
  std::uint32_t flags = 0;   // ResourceFlags
  VkFlags create_flags = 0;  // of a texture, TextureDesc::flags; of a buffer, BufferDesc::usage
  std::uint32_t planes = 1;  // aspects that are followed separately: 2 with depth and stencil
};
static_assert(std::has_unique_object_representations_v<ResourceRecord>);

constexpr bool has_depth_and_stencil(VkFormat format) {
  return format >= VK_FORMAT_D16_UNORM_S8_UINT && format <= VK_FORMAT_D32_SFLOAT_S8_UINT;
}

// Subresources are numbered mips within layers within planes; depth is the first of two planes.
constexpr std::uint32_t first_plane(const Range& range) {
  return range.aspects == VK_IMAGE_ASPECT_STENCIL_BIT ? 1 : 0;
}
constexpr std::uint32_t plane_count(const ResourceRecord& record, const Range& range) {
  return range.aspects != 0 ? 1 : record.planes;
}

inline bool has_one_subresource(const ResourceRecord& record) {
  return record.mips == 1 && record.layers == 1 && record.planes == 1;
}

enum ResourceFlags : std::uint32_t {
  kRelativeToNothing = 1,  // a relative extent of a dead handle
  kPersistent = 2,         // a history of one slot, which keeps its contents
};

// The state of a resource that exists outside the frame: an import or a history slot.
struct ExternalRecord {
  State initial_state;
  State final_state;
  VkFlags usage = 0;
  // The external that was imported before with the same Vulkan handle, kNone where there is none.
  std::uint32_t same_as = kNone;
  std::uint8_t has_contents = 0;                      // 0 or 1
  std::uint8_t has_final_state = 0;                   // 0 or 1
  std::uint8_t has_handle = 0;                        // 0 or 1: its Vulkan handle was given
  HistoryValidity validity = HistoryValidity::valid;  // of a history slot
  QueueClass queue = QueueClass::graphics;            // that used it last
  std::uint8_t reserved[3] = {};
};
static_assert(std::has_unique_object_representations_v<ExternalRecord>);

enum AccessFlags : std::uint32_t {
  kWrite = 1,
  kDiscard = 2,
  kOptional = 4,
  kForeign = 8,     // the handle was of another graph or frame
  kNull = 16,       // the handle was never made
  kClosed = 32,     // declared on a pass that is not the last
  kOnBuffer = 128,  // the handle was of a buffer
  // Contents::accumulate: the write is not ordered among others of the same access.
  kUnordered = 256,
  // Marks an OutputRecord that stands for a PassBuilder which was used after reset().
  kStaleBuilder = 1u << 16,
  // The bits from this one on hold the number of an attachment's rendering within its pass.
  kRendering = 1u << 24,
};

// The access bits that write: those of Vulkan and of its extensions, but for video.
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
  // Resolved: kAll only where the base is out of range, aspects only where it is one of two.
  Range range;
  std::uint32_t version = 0;  // that the access names: a write makes the next one

  ResourceKind kind() const {  // of the handle
    return flags & kOnBuffer ? ResourceKind::buffer : ResourceKind::texture;
  }
};
static_assert(std::has_unique_object_representations_v<AccessRecord>);

enum PassFlags : std::uint8_t { kSideEffect = 1, kHasCallback = 2 };

struct PassRecord {
  std::uint32_t first_access = 0;
  QueueClass queue = QueueClass::graphics;
  std::uint8_t flags = 0;
  std::uint16_t reserved = 0;
};
static_assert(std::has_unique_object_representations_v<PassRecord>);

// A version that is wanted after the frame.
struct OutputRecord {
  std::uint32_t resource = kNone;
  std::uint32_t version = 0;
  std::uint32_t flags = 0;  // kForeign, kNull, kStaleBuilder
};
static_assert(std::has_unique_object_representations_v<OutputRecord>);

struct GraphDescription {
  Records<PassRecord> passes;
  Records<AccessRecord> accesses;  // in order of passes
  Records<ResourceRecord> resources;
  Records<ExternalRecord> externals;
  Records<OutputRecord> outputs;
  // The number of the frame that first declared these records, passes excepted. Descriptions of one
  // edition have the same records, because no two frames of any graph have the same number.
  std::uint64_t edition = 0;

  // Names appear in messages only and are not compared.
  struct Name {
    std::uint32_t size = 0;
    std::uint32_t offset = 0;  // in long_names, where it is too long for the place here
    char place[24] = {};
  };
  std::string long_names;
  std::vector<Name> pass_names;  // with room for more, as resource_names
  std::vector<Name> resource_names;

  std::span<const AccessRecord> pass_accesses(std::uint32_t pass) const {
    const std::uint32_t first = passes[pass].first_access;
    const std::uint32_t last = pass + 1 < passes.size()
                                   ? passes[pass + 1].first_access
                                   : static_cast<std::uint32_t>(accesses.size());
    return {accesses.data() + first, last - first};
  }
  std::string_view pass_name(std::uint32_t pass) const { return text(pass_names[pass]); }
  std::string_view resource_name(std::uint32_t resource) const {
    return text(resource_names[resource]);
  }
  std::string_view text(const Name& name) const {
    const bool here = name.size <= sizeof name.place;
    return {here ? name.place : long_names.data() + name.offset, name.size};
  }
};

// Returns whether two frames were declared the same, names aside.
bool same_declaration(const GraphDescription& a, const GraphDescription& b);
// Returns a hash of everything that same_declaration compares.
std::uint64_t hash(const GraphDescription& description);

}  // namespace alcove::framegraph
